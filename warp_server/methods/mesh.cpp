/// One vertex per source pixel and two triangles between neighbours, drawn at their new places: what peers do. It is
/// sharp and has no cracks, and it stretches rubber sheets from every foreground edge to its background.

#include <cstdint>
#include <vector>

#include "gl/program.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/gl_source.h"
#include "warp_server/methods/gl_target.h"

namespace lw {
namespace {

constexpr std::uint32_t kRestart = 0xFFFFFFFFU;

// One triangle strip per row of cells of the vertex grid (shaders/warp/mesh.vert).
std::vector<std::uint32_t> strips_of(glm::ivec2 size_vertices) {
    const auto width = static_cast<std::uint32_t>(size_vertices.x);
    const auto height = static_cast<std::uint32_t>(size_vertices.y);
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t{height - 1} * (2 * std::size_t{width} + 1));
    for (std::uint32_t row = 0; row + 1 < height; ++row) {
        for (std::uint32_t column = 0; column < width; ++column) {
            indices.push_back(row * width + column);
            indices.push_back((row + 1) * width + column);
        }
        indices.push_back(kRestart);
    }
    return indices;
}

class MeshMethod final : public WarpMethod {
public:
    MeshMethod(std::string label, gl::Program program, GlBadPixelCounter bad_pixels)
        : label_{std::move(label)},
          program_{std::move(program)},
          bad_pixels_{std::move(bad_pixels)},
          vertices_{gl::make_vertex_array()} {
        source_size_ = program_.uniform("source_size_px");
        target_size_ = program_.uniform("target_size_px");
    }

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        build_strips(layer.camera.size_px);
        source_.bind(layer, target);
        bad_pixels_.count(layer.camera.size_px);
        target_.begin(target.camera.size_px, GlTarget::Writes::linear_light);
        program_.use();
        program_.set(source_size_, layer.camera.size_px);
        program_.set(target_size_, glm::vec2{target.camera.size_px});
        glBindVertexArray(vertices_.id());
        glEnable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
        glDrawElements(GL_TRIANGLE_STRIP, index_count_, GL_UNSIGNED_INT, nullptr);
        glDisable(GL_PRIMITIVE_RESTART_FIXED_INDEX);
        target_.read(out);
        counters_ = source_.counters();
    }

private:
    void build_strips(glm::ivec2 source_size_px) {
        if (source_size_px == strips_size_px_) return;
        strips_size_px_ = source_size_px;
        const std::vector<std::uint32_t> indices = strips_of(source_size_px + 2);
        index_count_ = static_cast<GLsizei>(indices.size());
        strips_ = gl::make_buffer(static_cast<GLsizeiptr>(indices.size() * sizeof(indices[0])), indices.data(), 0);
        glVertexArrayElementBuffer(vertices_.id(), strips_.id());
    }

    std::string label_;
    gl::Program program_;
    GlBadPixelCounter bad_pixels_;
    GLint source_size_ = -1;
    GLint target_size_ = -1;
    gl::VertexArray vertices_;
    gl::Buffer strips_;
    glm::ivec2 strips_size_px_{0};
    GLsizei index_count_ = 0;
    GlSource source_;
    GlTarget target_;
};

}  // namespace

MadeMethod make_mesh_method(std::string label, const MethodSettings& /*settings*/) {
    auto program = gl::Program::create({"warp/mesh.vert", "warp/mesh.frag"});
    if (!program) return program.error();
    auto bad_pixels = GlBadPixelCounter::create();
    if (!bad_pixels) return bad_pixels.error();
    return std::unique_ptr<WarpMethod>{
        std::make_unique<MeshMethod>(std::move(label), std::move(program).value(), std::move(bad_pixels).value())};
}

}  // namespace lw
