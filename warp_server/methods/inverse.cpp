/// For each target pixel a fixed-point search for the source place that lands on it: s += p - q(s). The published
/// alternative to splatting: sharp and cheap for small parallax, lost at large parallax and on thin things.

#include <algorithm>
#include <cmath>

#include "warp_server/methods/bilinear.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/object_matrices.h"

namespace lw {
namespace {

// A search that ended farther than this from its pixel found no surface there.
constexpr float kAcceptedErrorPx = 1.0F;
// Beyond any picture, and far from overflow.
constexpr float kLostPx = 1e6F;

class InverseMethod final : public WarpMethod {
public:
    InverseMethod(std::string label, int steps) : label_{std::move(label)}, steps_{steps} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        pixels_ = &checked_cpu_pixels(layer);
        matrices_.build(layer, target);
        size_px_ = layer.camera.size_px;
        start_ = glm::inverse(static_homography(layer.camera, target.camera));
        out.resize(target.camera.size_px);
        for (std::size_t i = 0; i < pixels_->depth.pixels().size(); ++i) {
            if (matrices_.find(pixels_->object_id.pixels()[i]) == nullptr) {
                ++counters_.unknown_object;
            } else if (!is_usable_depth(pixels_->depth.pixels()[i])) {
                ++counters_.bad_depth;
            }
        }
        for (int y = 0; y < out.colour.height(); ++y) {
            for (int x = 0; x < out.colour.width(); ++x) search(x, y, out);
        }
    }

private:
    static glm::mat3 static_homography(const Camera& source, const Camera& target) {
        Camera turned = target;
        turned.world_from_eye.position_m = source.world_from_eye.position_m;
        const glm::dmat4 m = static_target_px_from_source_px(source, turned).matrix;
        return glm::mat3{glm::dmat3{m[0].x, m[0].y, m[0].w, m[1].x, m[1].y, m[1].w, m[2].x, m[2].y, m[2].w}};
    }

    // Depth after placing, or below 0 for pixels that cannot be placed.
    float place(int x, int y, glm::vec2 source_px, glm::vec2& target_px) const {
        const float depth = pixels_->depth.at(x, y);
        const PixelMatrix* m = matrices_.find(pixels_->object_id.at(x, y));
        if (m == nullptr || !is_usable_depth(depth)) return -1.0F;
        const float w = m->one.w + source_px.y * m->y.w + source_px.x * m->x.w + depth * m->z.w;
        if (!(w > 0.0F)) return -1.0F;
        target_px = {(m->one.x + source_px.y * m->y.x + source_px.x * m->x.x + depth * m->z.x) / w,
                     (m->one.y + source_px.y * m->y.y + source_px.x * m->x.y + depth * m->z.y) / w};
        return depth * m->depth_scale / w;
    }

    void search(int x, int y, DisplayFrame& out) const {
        const glm::vec2 pixel{static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F};
        const glm::vec3 h = start_ * glm::vec3{pixel, 1.0F};
        out.coverage.at(x, y) = Coverage::hole;
        if (!(h.z > 0.0F)) return;
        const glm::vec2 limit = glm::vec2{size_px_} - 1e-3F;
        const glm::vec2 turned = glm::vec2{h} / h.z;
        if (std::isnan(turned.x) || std::isnan(turned.y)) return;
        glm::vec2 source_px = glm::clamp(turned, glm::vec2{0.0F}, limit);
        float depth = -1.0F;
        glm::vec2 error_px{1e9F};
        for (int step = 0; step <= steps_; ++step) {
            glm::vec2 landed{};
            depth = place(static_cast<int>(source_px.x), static_cast<int>(source_px.y), source_px, landed);
            if (depth < 0.0F) return;
            error_px = pixel - landed;
            // A place with w next to 0 may be infinitely far or no number: no step leads back from there.
            if (!(std::abs(error_px.x) < kLostPx && std::abs(error_px.y) < kLostPx)) return;
            if (step < steps_) source_px = glm::clamp(source_px + error_px, glm::vec2{0.0F}, limit);
        }
        if (depth > 1.0F || glm::dot(error_px, error_px) > kAcceptedErrorPx * kAcceptedErrorPx) return;
        out.colour.at(x, y) = sample_bilinear(pixels_->colour, bilinear_tap(source_px.x, source_px.y, size_px_));
        out.depth.at(x, y) = depth;
        out.coverage.at(x, y) = Coverage::reached;
    }

    std::string label_;
    int steps_;
    ObjectMatrices matrices_;
    const CpuPixels* pixels_ = nullptr;
    glm::ivec2 size_px_{0};
    glm::mat3 start_{1.0F};
};

}  // namespace

MadeMethod make_inverse_method(std::string label, const MethodSettings& settings) {
    const Result<int> steps = whole_setting(label, settings, "steps", 3, 1, 8);
    if (!steps) return steps.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<InverseMethod>(std::move(label), *steps)};
}

}  // namespace lw
