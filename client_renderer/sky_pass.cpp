#include "client_renderer/sky_pass.h"

#include <algorithm>

#include "gl/stream_buffer.h"

namespace lw {

namespace {

constexpr GLsizei kCornersPerRect = 6;
constexpr std::array<const char*, kSkyPartCount> kDefines{"#define GROUND\n", "#define ABOVE\n", "", "#define SUN\n"};

void append_corners(const SkyRect& rect, glm::ivec2 size_px, std::vector<glm::vec2>& corners) {
    const auto ndc_of = [&](int x, int y) {
        const glm::dvec2 share = glm::dvec2{x, y} / glm::dvec2{size_px};
        return glm::vec2{glm::dvec2{2.0 * share.x - 1.0, 1.0 - 2.0 * share.y}};
    };
    const glm::vec2 upper_left = ndc_of(rect.first_px.x, rect.first_px.y);
    const glm::vec2 upper_right = ndc_of(rect.end_px.x, rect.first_px.y);
    const glm::vec2 lower_left = ndc_of(rect.first_px.x, rect.end_px.y);
    const glm::vec2 lower_right = ndc_of(rect.end_px.x, rect.end_px.y);
    corners.insert(corners.end(), {upper_left, lower_left, upper_right, upper_right, lower_left, lower_right});
}

}  // namespace

Result<SkyPass> SkyPass::create() {
    SkyPass pass;
    for (std::size_t part = 0; part < pass.programs_.size(); ++part) {
        auto program = gl::Program::create({"client/sky.vert", "client/sky.frag"}, kDefines[part]);
        if (!program.ok()) return program.error();
        pass.programs_[part] = std::move(*program);
    }
    pass.corners_ = gl::make_stream_buffer();
    pass.vertex_array_ = gl::make_vertex_array();
    const GLuint id = pass.vertex_array_.id();
    constexpr auto kCorner = static_cast<GLuint>(shader::kAttributeSkyCorner);
    glVertexArrayVertexBuffer(id, 0, pass.corners_.id(), 0, sizeof(glm::vec2));
    glEnableVertexArrayAttrib(id, kCorner);
    glVertexArrayAttribFormat(id, kCorner, 2, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(id, kCorner, 0);
    return pass;
}

void SkyPass::draw(std::span<const SkyRect> rects, glm::ivec2 size_px) {
    if (rects.empty()) return;
    corner_list_.clear();
    for (const SkyRect& rect : rects) append_corners(rect, size_px, corner_list_);
    gl::replace(corners_, corner_list_);
    glBindVertexArray(vertex_array_.id());
    GLint first = 0;
    for (std::size_t part = 0; part < programs_.size(); ++part) {
        const auto in_part = [part](const SkyRect& rect) { return static_cast<std::size_t>(rect.part) == part; };
        const auto corners = static_cast<GLsizei>(std::ranges::count_if(rects, in_part)) * kCornersPerRect;
        if (corners == 0) continue;
        programs_[part].use();
        glDrawArrays(GL_TRIANGLES, first, corners);
        first += corners;
    }
    glBindVertexArray(0);
}

}  // namespace lw
