#include "apps/window_presenter.h"

#include <cstdlib>
#include <mutex>
#include <optional>
#include <utility>

#include "gl/framebuffer.h"
#include "warp_server/virtual_display.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace lw {
namespace {

bool is_set(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
}

Error glfw_error(const char* what) {
    const char* description = nullptr;
    glfwGetError(&description);
    return {what, description != nullptr ? description : "GLFW",
            "unset DISPLAY to run without a window, or install a driver with OpenGL 4.5"};
}

class GlfwPresenter final : public WindowPresenter {
public:
    GlfwPresenter(GLFWwindow* window, glm::ivec2 size_px, double hz) : window_{window}, size_px_{size_px}, hz_{hz} {
        glfwGetCursorPos(window_, &cursor_px_.x, &cursor_px_.y);
        glfwSetWindowUserPointer(window_, this);
        glfwSetKeyCallback(window_, [](GLFWwindow* pressed_in, int key, int, int action, int) {
            if (action != GLFW_PRESS) return;
            static_cast<GlfwPresenter*>(glfwGetWindowUserPointer(pressed_in))->note_key(key);
        });
        read_size();
    }
    ~GlfwPresenter() override {
        glfwDestroyWindow(window_);
        glfwTerminate();
    }

    [[nodiscard]] HeadInput wait_for_input(Duration longest) override {
        glfwWaitEventsTimeout(to_seconds(longest));
        if (is_down(GLFW_KEY_ESCAPE) || is_down(GLFW_KEY_Q) || glfwWindowShouldClose(window_) != 0) {
            closed_.store(true, std::memory_order_relaxed);
        }
        HeadInput input;
        input.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_C), axis(GLFW_KEY_S, GLFW_KEY_W)};
        input.fast = is_down(GLFW_KEY_LEFT_SHIFT);
        glm::dvec2 cursor_px{0.0};
        glfwGetCursorPos(window_, &cursor_px.x, &cursor_px.y);
        if (glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_LEFT) == GLFW_PRESS) input.turn_px = cursor_px - cursor_px_;
        cursor_px_ = cursor_px;
        read_size();
        return input;
    }

    [[nodiscard]] std::string take_keys() override { return std::exchange(keys_, {}); }

    void set_overlay(std::vector<OverlayPanel> panels) override {
        const std::lock_guard lock{overlay_mutex_};
        new_overlay_ = std::move(panels);
        overlay_changed_ = true;
    }

    void attach(TimePoint start) override {
        glfwMakeContextCurrent(window_);
        // The server keeps the time; a swap that waits for the screen would make every next latch late.
        glfwSwapInterval(0);
        timing_.emplace(start, hz_, glm::ivec2{1, 1});
        make_texture(size_px_);
    }
    void detach() override {
        framebuffer_ = {};
        texture_ = {};
        glfwMakeContextCurrent(nullptr);
    }

    [[nodiscard]] Refresh next_refresh(TimePoint now) const override { return timing_->next_refresh(now); }

    void present(const DisplayFrame& frame, const Refresh& refresh) override {
        if (frame.colour.size_px() != size_px_) make_texture(frame.colour.size_px());
        texture_.upload(GL_RGBA, GL_UNSIGNED_BYTE, frame.colour.pixels().data());
        if (on_picture) on_picture(frame.colour, refresh);
        show_texture();
    }

    void present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) override {
        (void)slot;
        upload(strip.colour, {0, place.top_px});
        // A window system shows whole pictures only.
        if (place.index + 1 == place.count) show_texture();
    }

    [[nodiscard]] bool closed() const override { return closed_.load(std::memory_order_relaxed); }

private:
    void make_texture(glm::ivec2 size_px) {
        size_px_ = size_px;
        texture_ = gl::Texture{size_px_, GL_RGBA8};
        framebuffer_ = *gl::Framebuffer::create({&texture_}, nullptr);
    }

    void note_key(int key) {
        if (key == GLFW_KEY_KP_ADD || key == GLFW_KEY_EQUAL) key = '+';
        if (key == GLFW_KEY_KP_SUBTRACT) key = '-';
        if (key >= ' ' && key <= 'Z') keys_.push_back(static_cast<char>(key));
    }

    void upload(const ColourImage& picture, glm::ivec2 corner_px) {
        const glm::ivec2 room_px = glm::min(picture.size_px(), size_px_ - corner_px);
        if (room_px.x <= 0 || room_px.y <= 0) return;
        glPixelStorei(GL_UNPACK_ROW_LENGTH, picture.width());
        glTextureSubImage2D(texture_.id(), 0, corner_px.x, corner_px.y, room_px.x, room_px.y, GL_RGBA, GL_UNSIGNED_BYTE,
                            picture.pixels().data());
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    }

    /// The server never waits for the main thread: it shows the old panels once more.
    void take_overlay() {
        const std::unique_lock lock{overlay_mutex_, std::try_to_lock};
        if (!lock.owns_lock() || !overlay_changed_) return;
        overlay_ = std::move(new_overlay_);
        overlay_changed_ = false;
    }

    void show_texture() {
        take_overlay();
        for (const OverlayPanel& panel : overlay_) upload(panel.picture, panel.corner_px);
        const int width = window_width_.load(std::memory_order_relaxed);
        const int height = window_height_.load(std::memory_order_relaxed);
        // A minimised window has no pixels.
        if (width <= 0 || height <= 0) return;
        // Row 0 is the top row of the texture, and the bottom row of a window.
        glBlitNamedFramebuffer(framebuffer_.id(), 0, 0, 0, size_px_.x, size_px_.y, 0, height, width, 0,
                               GL_COLOR_BUFFER_BIT, GL_LINEAR);
        glfwSwapBuffers(window_);
    }

    void read_size() {
        glm::ivec2 window_px{0};
        glfwGetFramebufferSize(window_, &window_px.x, &window_px.y);
        window_width_.store(window_px.x, std::memory_order_relaxed);
        window_height_.store(window_px.y, std::memory_order_relaxed);
    }
    [[nodiscard]] bool is_down(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }
    [[nodiscard]] double axis(int positive, int negative) const {
        return (is_down(positive) ? 1.0 : 0.0) - (is_down(negative) ? 1.0 : 0.0);
    }

    GLFWwindow* window_;
    glm::ivec2 size_px_;
    double hz_;
    glm::dvec2 cursor_px_{0.0};
    std::atomic<int> window_width_{0};
    std::atomic<int> window_height_{0};
    std::atomic<bool> closed_{false};
    std::optional<VirtualDisplay> timing_;
    std::string keys_;
    std::mutex overlay_mutex_;
    std::vector<OverlayPanel> new_overlay_;
    bool overlay_changed_ = false;
    std::vector<OverlayPanel> overlay_;  ///< server's own
    gl::Texture texture_;
    gl::Framebuffer framebuffer_;
};

}  // namespace

bool WindowPresenter::is_display_present() { return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY"); }

Result<std::unique_ptr<WindowPresenter>> WindowPresenter::create(const std::string& title, glm::ivec2 size_px,
                                                                 double hz) {
    if (glfwInit() == GLFW_FALSE) return glfw_error("cannot reach the display");
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    GLFWwindow* window = glfwCreateWindow(size_px.x, size_px.y, title.c_str(), nullptr, nullptr);
    if (window == nullptr) {
        Error error = glfw_error("cannot make a window");
        glfwTerminate();
        return error;
    }
    return std::unique_ptr<WindowPresenter>{std::make_unique<GlfwPresenter>(window, size_px, hz)};
}

}  // namespace lw
