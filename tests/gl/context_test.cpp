#include "gl/context.h"

#include <cstdlib>
#include <thread>

#include "gl/api.h"
#include "gl/fence.h"
#include "gl/texture.h"
#include "tests/support/gl_test.h"

namespace lw::gl {
namespace {

class GlContext : public test::GlTest {};

TEST_F(GlContext, SaysWhoDraws) {
    EXPECT_FALSE(context().renderer().empty());
    EXPECT_GE(context().version(), "4.5");
    EXPECT_EQ(context().is_software(), is_software_renderer(context().renderer()));
}

TEST_F(GlContext, AppliesTheConventions) {
    GLint origin = 0;
    GLint range = 0;
    GLint function = 0;
    GLfloat clear_depth = 1.0F;
    glGetIntegerv(GL_CLIP_ORIGIN, &origin);
    glGetIntegerv(GL_CLIP_DEPTH_MODE, &range);
    glGetIntegerv(GL_DEPTH_FUNC, &function);
    glGetFloatv(GL_DEPTH_CLEAR_VALUE, &clear_depth);
    EXPECT_EQ(origin, GL_UPPER_LEFT);
    EXPECT_EQ(range, GL_ZERO_TO_ONE);
    EXPECT_EQ(function, GL_GEQUAL);
    EXPECT_EQ(clear_depth, 0.0F);
}

TEST_F(GlContext, CollectsWhatTheDriverReports) {
    glBindTexture(GL_ARRAY_BUFFER, 0);  // not a texture target
    const std::string messages = take_debug_messages();
    EXPECT_NE(messages.find("glBindTexture"), std::string::npos) << messages;
    EXPECT_EQ(take_debug_messages(), "");
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_INVALID_ENUM));
}

TEST_F(GlContext, CreatingAnotherLeavesTheCurrentOneCurrent) {
    const Texture texture{{1, 1}, GL_R32F};
    {
        auto other = Context::create();
        ASSERT_TRUE(other.ok()) << other.error().message();
    }
    EXPECT_EQ(glIsTexture(texture.id()), GL_TRUE);
}

float cleared_on(Context& context, float value) {
    context.make_current();
    Texture texture{{4, 4}, GL_R32F};
    glClearTexImage(texture.id(), 0, GL_RED, GL_FLOAT, &value);
    std::array<float, 16> pixels{};
    texture.download(GL_RED, GL_FLOAT, sizeof pixels, pixels.data());
    texture = {};
    context.release_current();
    return pixels[7];
}

TEST_F(GlContext, TwoContextsWorkOnTwoThreads) {
    auto first = Context::create();
    auto second = Context::create();
    ASSERT_TRUE(first.ok() && second.ok());
    float a = 0.0F;
    float b = 0.0F;
    std::string debug_a;
    std::string debug_b;
    std::thread thread_a{[&] {
        for (int i = 0; i < 10; ++i) a += cleared_on(**first, 1.0F);
        debug_a = take_debug_messages();
    }};
    std::thread thread_b{[&] {
        for (int i = 0; i < 10; ++i) b += cleared_on(**second, 2.0F);
        debug_b = take_debug_messages();
    }};
    thread_a.join();
    thread_b.join();
    EXPECT_EQ(a, 10.0F);
    EXPECT_EQ(b, 20.0F);
    EXPECT_EQ(debug_a + debug_b, "");
}

TEST_F(GlContext, SoftwareContextsThatDoNotShareHaveTheirOwnDisplay) {
    if (!context().is_software()) GTEST_SKIP() << "on a GPU all contexts use one display";
    auto other = Context::create();
    ASSERT_TRUE(other.ok());
    EXPECT_NE((*other)->egl_handles().display, context().egl_handles().display);
    auto shared = Context::create(&context());
    ASSERT_TRUE(shared.ok());
    EXPECT_EQ((*shared)->egl_handles().display, context().egl_handles().display);
}

TEST_F(GlContext, ASharedContextSeesTexturesAndFences) {
    auto shared = Context::create(&context());
    ASSERT_TRUE(shared.ok()) << shared.error().message();
    const Texture texture{{2, 2}, GL_R16UI};
    const GLushort value = 40'000;
    glClearTexImage(texture.id(), 0, GL_RED_INTEGER, GL_UNSIGNED_SHORT, &value);
    const Fence fence = Fence::insert();
    std::array<GLushort, 4> pixels{};
    std::thread reader{[&] {
        (*shared)->make_current();
        while (!fence.signalled()) std::this_thread::yield();
        texture.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, sizeof pixels, pixels.data());
        (*shared)->release_current();
    }};
    reader.join();
    EXPECT_EQ(pixels, (std::array<GLushort, 4>{value, value, value, value}));
}

// Runs in a process of its own, before anything of GL is loaded there; what happened comes back on standard error.
[[noreturn]] void report_creation(const char* variable, const char* value) {
    setenv(variable, value, 1);
    const auto context = Context::create();
    if (!context.ok()) {
        fmt::print(stderr, "{}\n", context.error().message());
    } else {
        const bool is_mesa = (*context)->version().find("Mesa") != std::string::npos;
        fmt::print(stderr, "{}\n", is_mesa ? "created all the same" : "a driver that cannot pretend");
    }
    std::_Exit(0);
}

class GlMissingDeathTest : public testing::Test {
protected:
    GlMissingDeathTest() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(GlMissingDeathTest, NoDriverIsOneClearError) {
    EXPECT_EXIT(report_creation("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json"), testing::ExitedWithCode(0),
                "install a driver with OpenGL 4.5");
}

TEST_F(GlMissingDeathTest, AnOldVersionIsNamed) {
    EXPECT_EXIT(report_creation("MESA_GL_VERSION_OVERRIDE", "3.3"), testing::ExitedWithCode(0),
                "OpenGL 4.5 is not there: the driver offers 3.3|a driver that cannot pretend|install a driver");
}

}  // namespace
}  // namespace lw::gl
