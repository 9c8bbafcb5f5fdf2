#include "billboard_lod/billboard_pass.h"

#include <algorithm>
#include <compare>
#include <string>

#include "core/check.h"
#include "gl/stream_buffer.h"

namespace lw {

namespace {

/// NDC = tangent * xy + zw.
glm::vec4 ndc_from_tangent(const FovTangents& fov) {
    const glm::dvec2 size{fov.right - fov.left, fov.up - fov.down};
    const glm::dvec2 sum{fov.right + fov.left, fov.up + fov.down};
    return glm::vec4{glm::dvec4{2.0 / size, -sum / size}};
}

/// What is drawn at once, in the order in which it is drawn.
struct Batch {
    float opacity;
    AtlasPage page;

    friend auto operator<=>(const Batch&, const Batch&) = default;
};

Batch batch_of(const DrawnQuad& quad) { return {quad.opacity, quad.page}; }

}  // namespace

Result<BillboardPass> BillboardPass::create(const BillboardPassSettings& settings) {
    BillboardPass pass;
    pass.expansion_ = settings.expansion;
    std::string defines{defines_of(settings.format)};
    if (settings.warped) defines += "#define WARPED\n";
    if (settings.blended) defines += "#define BLENDED\n";
    if (settings.expansion == QuadExpansion::instances) defines += "#define INSTANCED\n";
    auto surfaces = compile(settings.expansion, defines);
    if (!surfaces.ok()) return surfaces.error();
    pass.surfaces_ = std::move(*surfaces);
    if (settings.into_picture) {
        if (settings.point_lights) defines += "#define POINT_LIGHTS\n";
        auto lit = compile(settings.expansion, defines + "#define LIT\n");
        if (!lit.ok()) return lit.error();
        pass.lit_ = std::move(*lit);
    }
    pass.records_ = gl::make_stream_buffer();
    pass.active_ = gl::make_stream_buffer();
    pass.vertex_array_ = gl::make_vertex_array();
    glVertexArrayElementBuffer(pass.vertex_array_.id(), pass.active_.id());
    return pass;
}

Result<BillboardPass::Way> BillboardPass::compile(QuadExpansion expansion, const std::string& defines) {
    const bool geometry = expansion == QuadExpansion::geometry;
    auto program = geometry
                       ? gl::Program::create(
                             {"billboards/point.vert", "billboards/quad.geom", "billboards/billboard.frag"}, defines)
                       : gl::Program::create({"billboards/quad.vert", "billboards/billboard.frag"}, defines);
    if (!program.ok()) return program.error();
    Way way;
    way.program = std::move(*program);
    way.ndc_from_tangent = way.program.uniform("u_ndc_from_tangent");
    way.near_m = way.program.uniform("u_near_m");
    if (!geometry) way.first = way.program.uniform("u_first");
    return way;
}

void BillboardPass::draw(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera) {
    draw(surfaces_, quads, atlas, camera);
}

void BillboardPass::draw_lit(std::span<const DrawnQuad> quads, const BillboardAtlas& atlas, const Camera& camera) {
    LW_CHECK(lit_.program.id() != 0, "made without into_picture");
    glEnablei(GL_BLEND, 0);  // ids are integers, which are never blended
    glBlendFunc(GL_CONSTANT_ALPHA, GL_ONE_MINUS_CONSTANT_ALPHA);
    draw(lit_, quads, atlas, camera);
    glDisablei(GL_BLEND, 0);
}

void BillboardPass::draw(const Way& way, std::span<const DrawnQuad> quads, const BillboardAtlas& atlas,
                         const Camera& camera) {
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
    way.program.use();
    way.program.set(way.ndc_from_tangent, ndc_from_tangent(camera.fov));
    way.program.set(way.near_m, static_cast<float>(camera.near_m));
    for (std::size_t first = 0, end = 0; first < active_list_.size(); first = end) {
        const Batch batch = batch_of(quads[active_list_[first]]);
        while (end < active_list_.size() && batch_of(quads[active_list_[end]]) == batch) ++end;
        glBlendColor(0.0f, 0.0f, 0.0f, batch.opacity);
        atlas.bind_textures(batch.page);
        draw_range(way, first, end - first);
    }
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
}

void BillboardPass::draw_range(const Way& way, std::size_t first, std::size_t count) const {
    const auto quads = static_cast<GLsizei>(count);
    if (expansion_ == QuadExpansion::geometry) {
        glDrawElements(GL_POINTS, quads, GL_UNSIGNED_INT, gl::buffer_offset(first * sizeof(std::uint32_t)));
        return;
    }
    way.program.set(way.first, static_cast<int>(first));
    if (expansion_ == QuadExpansion::instances) {
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, quads);
    } else {
        glDrawArrays(GL_TRIANGLES, 0, 6 * quads);
    }
}

}  // namespace lw
