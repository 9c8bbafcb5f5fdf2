#include "billboard_lod/billboard_pass.h"

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

bool dithered(const DrawnQuad& quad) { return quad.record.extent.y > 0.0f || quad.record.extent.z < 1.0f; }

}  // namespace

Result<BillboardPass> BillboardPass::create(AtlasFormat format, QuadExpansion expansion, bool warped) {
    BillboardPass pass;
    pass.expansion_ = expansion;
    for (std::size_t dither = 0; dither < 2; ++dither) {
        std::string defines{defines_of(format)};
        if (warped) defines += "#define WARPED\n";
        if (expansion == QuadExpansion::instances) defines += "#define INSTANCED\n";
        if (dither == 1) defines += "#define DITHERED\n";
        auto program = compile(expansion, defines);
        if (!program.ok()) return program.error();
        Variant& variant = pass.variants_[dither];
        variant.program = std::move(*program);
        variant.ndc_from_tangent = variant.program.uniform("u_ndc_from_tangent");
        variant.near_m = variant.program.uniform("u_near_m");
        if (expansion != QuadExpansion::geometry) variant.first = variant.program.uniform("u_first");
    }
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
    for (const DrawnQuad& quad : quads) record_list_.push_back(quad.record);
    struct Range {
        std::size_t level;
        std::size_t dither;
        std::size_t first;
        std::size_t count;
    };
    std::vector<Range> ranges;
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        for (std::size_t dither = 0; dither < 2; ++dither) {
            const std::size_t first = active_list_.size();
            for (std::size_t i = 0; i < quads.size(); ++i) {
                if (quads[i].level == level && dithered(quads[i]) == (dither == 1)) {
                    active_list_.push_back(static_cast<std::uint32_t>(i));
                }
            }
            if (active_list_.size() > first) ranges.push_back({level, dither, first, active_list_.size() - first});
        }
    }
    gl::replace(records_, record_list_);
    gl::replace(active_, active_list_);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shader::kBindingBillboards, records_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shader::kBindingActive, active_.id());
    glBindVertexArray(vertex_array_.id());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    for (const Range& range : ranges) {
        const Variant& variant = variants_[range.dither];
        variant.program.use();
        variant.program.set(variant.ndc_from_tangent, ndc_from_tangent(camera.fov));
        variant.program.set(variant.near_m, static_cast<float>(camera.near_m));
        atlas.bind_textures(range.level);
        draw_level(variant, range.first, range.count);
    }
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
}

void BillboardPass::draw_level(const Variant& variant, std::size_t first, std::size_t count) const {
    const auto quads = static_cast<GLsizei>(count);
    if (expansion_ == QuadExpansion::geometry) {
        glDrawElements(GL_POINTS, quads, GL_UNSIGNED_INT, gl::buffer_offset(first * sizeof(std::uint32_t)));
        return;
    }
    variant.program.set(variant.first, static_cast<int>(first));
    if (expansion_ == QuadExpansion::instances) {
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, quads);
    } else {
        glDrawArrays(GL_TRIANGLES, 0, 6 * quads);
    }
}

}  // namespace lw
