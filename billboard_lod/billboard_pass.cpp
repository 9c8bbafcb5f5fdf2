#include "billboard_lod/billboard_pass.h"

#include <algorithm>
#include <compare>
#include <string>

#include "gl/stream_buffer.h"

namespace lw {

namespace {

Result<gl::Program> compile(QuadExpansion expansion, const std::string& defines) {
    if (expansion == QuadExpansion::geometry) {
        return gl::Program::create({"billboards/point.vert", "billboards/quad.geom", "billboards/billboard.frag"},
                                   defines);
    }
    return gl::Program::create({"billboards/quad.vert", "billboards/billboard.frag"}, defines);
}

/// NDC = tangent * xy + zw.
glm::vec4 ndc_from_tangent(const FovTangents& fov) {
    const glm::dvec2 size{fov.right - fov.left, fov.up - fov.down};
    const glm::dvec2 sum{fov.right + fov.left, fov.up + fov.down};
    return glm::vec4{glm::dvec4{2.0 / size, -sum / size}};
}

/// What is drawn at once, in the order in which it is drawn.
struct Batch {
    bool replaces;
    bool blended;
    float opacity;
    std::size_t level;

    friend auto operator<=>(const Batch&, const Batch&) = default;
};

Batch batch_of(const DrawnQuad& quad) { return {quad.replaces, quad.opacity < 1.0f, quad.opacity, quad.level}; }

/// Over the surfaces of the G-buffer; its ids are integers, which are never blended.
void blend(float opacity) {
    constexpr GLuint kSurfaces = 3;
    for (GLuint i = 0; i < kSurfaces; ++i) {
        if (opacity < 1.0f) {
            glEnablei(GL_BLEND, i);
        } else {
            glDisablei(GL_BLEND, i);
        }
    }
    glBlendColor(0.0f, 0.0f, 0.0f, opacity);
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
}

}  // namespace

Result<BillboardPass> BillboardPass::create(AtlasFormat format, QuadExpansion expansion, bool warped) {
    BillboardPass pass;
    pass.expansion_ = expansion;
    std::string defines{defines_of(format)};
    if (warped) defines += "#define WARPED\n";
    if (expansion == QuadExpansion::instances) defines += "#define INSTANCED\n";
    auto program = compile(expansion, defines);
    if (!program.ok()) return program.error();
    pass.program_ = std::move(*program);
    pass.ndc_from_tangent_ = pass.program_.uniform("u_ndc_from_tangent");
    pass.near_m_ = pass.program_.uniform("u_near_m");
    if (expansion != QuadExpansion::geometry) pass.first_ = pass.program_.uniform("u_first");
    pass.records_ = gl::make_stream_buffer();
    pass.active_ = gl::make_stream_buffer();
    pass.vertex_array_ = gl::make_vertex_array();
    glVertexArrayElementBuffer(pass.vertex_array_.id(), pass.active_.id());
    return pass;
}

void BillboardPass::draw(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera) {
    if (quads.empty()) return;
    record_list_.clear();
    active_list_.clear();
    for (const DrawnQuad& quad : quads) {
        active_list_.push_back(static_cast<std::uint32_t>(record_list_.size()));
        record_list_.push_back(quad.record);
    }
    std::ranges::stable_sort(active_list_, {}, [&](std::uint32_t i) { return batch_of(quads[i]); });
    gl::replace(records_, record_list_);
    gl::replace(active_, active_list_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shader::kBindingBillboards, records_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shader::kBindingActive, active_.id());
    glBindVertexArray(vertex_array_.id());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    program_.use();
    program_.set(ndc_from_tangent_, ndc_from_tangent(camera.fov));
    program_.set(near_m_, static_cast<float>(camera.near_m));
    for (std::size_t first = 0, end = 0; first < active_list_.size(); first = end) {
        const Batch batch = batch_of(quads[active_list_[first]]);
        while (end < active_list_.size() && batch_of(quads[active_list_[end]]) == batch) ++end;
        blend(batch.opacity);
        atlas.bind_textures(batch.level);
        draw_range(first, end - first);
    }
    blend(1.0f);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
}

void BillboardPass::draw_range(std::size_t first, std::size_t count) const {
    const auto quads = static_cast<GLsizei>(count);
    if (expansion_ == QuadExpansion::geometry) {
        glDrawElements(GL_POINTS, quads, GL_UNSIGNED_INT, gl::buffer_offset(first * sizeof(std::uint32_t)));
        return;
    }
    program_.set(first_, static_cast<int>(first));
    if (expansion_ == QuadExpansion::instances) {
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, quads);
    } else {
        glDrawArrays(GL_TRIANGLES, 0, 6 * quads);
    }
}

}  // namespace lw
