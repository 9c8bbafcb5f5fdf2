#include "client_renderer/lighting_pass.h"

#include "gl/stream_buffer.h"

namespace lw {

namespace {

void bind_texture(int unit, const gl::Texture& texture) {
    glBindTextureUnit(static_cast<GLuint>(unit), texture.id());
    glBindSampler(static_cast<GLuint>(unit), 0);
}

}  // namespace

Result<LightingPass> LightingPass::create(bool point_lights) {
    auto sky = SkyPass::create();
    if (!sky.ok()) return sky.error();
    LightingPass pass{std::move(*sky)};
    pass.point_lights_ = point_lights;
    auto surfaces = gl::Program::create({"client/fullscreen.vert", "client/lighting.frag"},
                                        point_lights ? "#define POINT_LIGHTS\n" : "");
    if (!surfaces.ok()) return surfaces.error();
    if (point_lights) {
        auto cull_lights = gl::Program::create({"client/light_tiles.comp"});
        if (!cull_lights.ok()) return cull_lights.error();
        pass.cull_lights_ = std::move(*cull_lights);
    }
    pass.surfaces_ = std::move(*surfaces);
    pass.light_block_ = gl::make_stream_buffer();
    pass.tile_masks_ = gl::make_stream_buffer();
    pass.no_attributes_ = gl::make_vertex_array();
    return pass;
}

void LightingPass::cull_lights(const RenderTargets& targets, const LightTiles& lights) {
    glNamedBufferData(light_block_.id(), sizeof(shader::LightsBlock), &lights.block(), GL_STREAM_DRAW);
    glNamedBufferData(tile_masks_.id(), static_cast<GLsizeiptr>(lights.masks().size() * sizeof(glm::uvec2)),
                      lights.masks().data(), GL_STREAM_DRAW);
    glBindBufferBase(GL_UNIFORM_BUFFER, shader::kBindingLights, light_block_.id());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, shader::kBindingTiles, tile_masks_.id());
    cull_lights_.use();
    const glm::uvec2 tiles{LightTiles::tiles_for(targets.colour.size_px())};
    glDispatchCompute(tiles.x, tiles.y, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void LightingPass::draw(const RenderTargets& targets, const LightTiles& lights, std::span<const SkyRect> sky) {
    bind_texture(shader::kUnitGAlbedo, targets.albedo_roughness);
    bind_texture(shader::kUnitGNormal, targets.normal);
    bind_texture(shader::kUnitGEmissive, targets.emissive_metallic);
    bind_texture(shader::kUnitGDepth, targets.depth);
    if (point_lights_) cull_lights(targets, lights);
    targets.lit.bind();
    glBindVertexArray(no_attributes_.id());
    // The triangle lies at depth 0. Depth is read by test and by fetch and never written here, so this is no feedback.
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LESS);
    surfaces_.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_EQUAL);
    sky_.draw(sky, targets.colour.size_px());

    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(0);
}

}  // namespace lw
