/// Every source pixel a GL point through a vertex shader: the classic architecture (seed document 004, p. 53-60).

#include "gl/program.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/gl_source.h"
#include "warp_server/methods/gl_target.h"

namespace lw {
namespace {

// Points larger than this cover more than they mend.
constexpr double kLargestSizePx = 8.0;
// Best of 1, 2 and 3 px for all but the smallest motions.
constexpr double kDefaultSizePx = 2.0;

class PointsMethod final : public WarpMethod {
public:
    PointsMethod(std::string label, gl::Program program, float size_px)
        : label_{std::move(label)}, program_{std::move(program)}, vertices_{gl::make_vertex_array()} {
        source_size_ = program_.uniform("source_size_px");
        target_size_ = program_.uniform("target_size_px");
        program_.set("size_px", size_px);
    }

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        source_.bind(layer, target);
        target_.begin(target.camera.size_px, GlTarget::Writes::stored_bytes);
        program_.use();
        program_.set(source_size_, layer.camera.size_px);
        program_.set(target_size_, glm::vec2{target.camera.size_px});
        glEnable(GL_PROGRAM_POINT_SIZE);
        glBindVertexArray(vertices_.id());  // no attributes: the vertex shader fetches its pixel
        glDrawArrays(GL_POINTS, 0, layer.camera.size_px.x * layer.camera.size_px.y);
        target_.read(out);
        counters_ = source_.counters();
    }

private:
    std::string label_;
    gl::Program program_;
    GLint source_size_ = -1;
    GLint target_size_ = -1;
    gl::VertexArray vertices_;
    GlSource source_;
    GlTarget target_;
};

}  // namespace

MadeMethod make_points_method(std::string label, const MethodSettings& settings) {
    const auto found = settings.find("size_px");
    const double size_px = found != settings.end() ? found->second : kDefaultSizePx;
    if (size_px != 0.0 && !(size_px >= 1.0 && size_px <= kLargestSizePx)) {
        return Error{"'size_px' out of range", label,
                     fmt::format("give 1 to {}, or 0 for the size of the pixel's surface", kLargestSizePx)};
    }
    auto program = gl::Program::create({"warp/points.vert", "warp/points.frag"});
    if (!program) return program.error();
    return std::unique_ptr<WarpMethod>{
        std::make_unique<PointsMethod>(std::move(label), std::move(program).value(), static_cast<float>(size_px))};
}

}  // namespace lw
