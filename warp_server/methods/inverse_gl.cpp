/// `inverse` in a compute shader: for each target pixel a fixed-point search for the source place that lands on it.

#include "gl/program.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/gl_images.h"
#include "warp_server/methods/gl_source.h"

namespace lw {
namespace {

// Source from target pixels of things infinitely far away.
glm::mat3 far_source_px_from_target_px(const Camera& source, const Camera& target) {
    Camera turned = target;
    turned.world_from_eye.position_m = source.world_from_eye.position_m;
    const glm::dmat4 m = static_target_px_from_source_px(source, turned).matrix;
    const glm::dmat3 target_px_from_source_px{m[0].x, m[0].y, m[0].w, m[1].x, m[1].y, m[1].w, m[2].x, m[2].y, m[2].w};
    return glm::mat3{glm::inverse(target_px_from_source_px)};
}

class InverseGlMethod final : public WarpMethod {
public:
    InverseGlMethod(std::string label, gl::Program program, GlBadPixelCounter bad_pixels, int steps)
        : label_{std::move(label)}, program_{std::move(program)}, bad_pixels_{std::move(bad_pixels)} {
        source_size_ = program_.uniform("source_size_px");
        target_size_ = program_.uniform("target_size_px");
        start_ = program_.uniform("source_px_from_target_px");
        program_.set("steps", steps);
    }

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        source_.bind(layer, target);
        bad_pixels_.count(layer.camera.size_px);
        images_.begin(target.camera.size_px);
        program_.use();
        program_.set(source_size_, layer.camera.size_px);
        program_.set(target_size_, target.camera.size_px);
        program_.set(start_, far_source_px_from_target_px(layer.camera, target.camera));
        const glm::uvec2 groups = work_groups(target.camera.size_px);
        glDispatchCompute(groups.x, groups.y, 1);
        images_.read(out);
        counters_ = source_.counters();
    }

private:
    std::string label_;
    gl::Program program_;
    GlBadPixelCounter bad_pixels_;
    GLint source_size_ = -1;
    GLint target_size_ = -1;
    GLint start_ = -1;
    GlSource source_;
    GlImages images_;
};

}  // namespace

MadeMethod make_inverse_gl_method(std::string label, const MethodSettings& settings) {
    const Result<int> steps = whole_setting(label, settings, "steps", 3, 1, 8);
    if (!steps) return steps.error();
    auto program = gl::Program::create({"warp/inverse.comp"});
    if (!program) return program.error();
    auto bad_pixels = GlBadPixelCounter::create();
    if (!bad_pixels) return bad_pixels.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<InverseGlMethod>(std::move(label), std::move(program).value(),
                                                                         std::move(bad_pixels).value(), *steps)};
}

}  // namespace lw
