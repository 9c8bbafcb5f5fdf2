#include "client_renderer/surface_resolve.h"

#include <utility>

#include "shaders/client_blocks.h"

namespace lw {

namespace {

void bind_texture(int unit, const gl::Texture& texture) {
    glBindTextureUnit(static_cast<GLuint>(unit), texture.id());
    glBindSampler(static_cast<GLuint>(unit), 0);
}

}  // namespace

Result<LayerTextures> LayerTextures::create(glm::ivec2 size_px) {
    LayerTextures layer;
    layer.colour = gl::Texture{size_px, GL_SRGB8_ALPHA8};
    layer.depth = gl::Texture{size_px, GL_R32F};
    layer.object_id = gl::Texture{size_px, GL_R16UI};
    auto framebuffer = gl::Framebuffer::create({&layer.colour, &layer.depth, &layer.object_id}, nullptr);
    if (!framebuffer.ok()) return framebuffer.error();
    layer.framebuffer = std::move(*framebuffer);
    return layer;
}

Result<QuarterTexture> QuarterTexture::create(glm::ivec2 layer_size_px) {
    QuarterTexture quarters;
    quarters.colour = gl::Texture{2 * layer_size_px, GL_SRGB8_ALPHA8};
    auto framebuffer = gl::Framebuffer::create({&quarters.colour}, nullptr);
    if (!framebuffer.ok()) return framebuffer.error();
    quarters.framebuffer = std::move(*framebuffer);
    return quarters;
}

Result<SurfaceResolve::Variant> SurfaceResolve::make_variant(const std::string& defines) {
    auto program = gl::Program::create({"client/fullscreen.vert", "client/resolve_surface.frag"}, defines);
    if (!program.ok()) return program.error();
    const GLint first_px = program->uniform("u_first_px");
    return Variant{std::move(*program), first_px};
}

Result<SurfaceResolve::Variants> SurfaceResolve::make_variants(int samples_per_axis) {
    const std::string samples = fmt::format("#define SAMPLES {}\n", samples_per_axis);
    auto pixels = make_variant(samples);
    if (!pixels.ok()) return pixels.error();
    auto quarters = make_variant(samples + "#define QUARTERS\n");
    if (!quarters.ok()) return quarters.error();
    return Variants{std::move(*pixels), std::move(*quarters)};
}

Result<SurfaceResolve> SurfaceResolve::create() {
    auto two = make_variants(2);
    if (!two.ok()) return two.error();
    auto four = make_variants(4);
    if (!four.ok()) return four.error();
    SurfaceResolve resolve;
    resolve.two_ = std::move(*two);
    resolve.four_ = std::move(*four);
    resolve.no_attributes_ = gl::make_vertex_array();
    return resolve;
}

const SurfaceResolve::Variants& SurfaceResolve::variants(int samples_per_axis) const {
    LW_CHECK(samples_per_axis == 2 || samples_per_axis == 4, fmt::format("{} samples per axis", samples_per_axis));
    return samples_per_axis == 2 ? two_ : four_;
}

void SurfaceResolve::draw(const RenderTargets& samples, int samples_per_axis, glm::ivec2 first_px,
                          const LayerTextures& layer) {
    const glm::ivec2 size_px = samples.colour.size_px() / samples_per_axis;
    layer.framebuffer.bind();
    glViewport(first_px.x, first_px.y, size_px.x, size_px.y);
    draw(variants(samples_per_axis).pixels, samples, first_px);
}

void SurfaceResolve::draw_quarters(const RenderTargets& samples, int samples_per_axis, glm::ivec2 first_px,
                                   const QuarterTexture& quarters) {
    const glm::ivec2 size_px = samples.colour.size_px() / samples_per_axis;
    quarters.framebuffer.bind();
    glViewport(2 * first_px.x, 2 * first_px.y, 2 * size_px.x, 2 * size_px.y);
    draw(variants(samples_per_axis).quarters, samples, first_px);
}

// Into the framebuffer and viewport that are bound.
void SurfaceResolve::draw(const Variant& variant, const RenderTargets& samples, glm::ivec2 first_px) {
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_attributes_.id());
    bind_texture(shader::kUnitSampleColour, samples.colour);
    bind_texture(shader::kUnitSampleDepth, samples.depth);
    bind_texture(shader::kUnitSampleId, samples.object_id);
    variant.program.set(variant.first_px, first_px);
    variant.program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace lw
