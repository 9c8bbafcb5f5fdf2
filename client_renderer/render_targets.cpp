#include "client_renderer/render_targets.h"

namespace lw {

Result<std::unique_ptr<RenderTargets>> RenderTargets::create(glm::ivec2 size_px) {
    auto targets = std::make_unique<RenderTargets>();
    targets->albedo_roughness = gl::Texture{size_px, GL_RGBA8};
    targets->normal = gl::Texture{size_px, GL_RG16};
    targets->emissive_metallic = gl::Texture{size_px, GL_RGBA8};
    targets->object_id = gl::Texture{size_px, GL_R16UI};
    targets->depth = gl::Texture{size_px, GL_DEPTH_COMPONENT32F};
    targets->colour = gl::Texture{size_px, GL_SRGB8_ALPHA8};
    auto gbuffer = gl::Framebuffer::create(
        {&targets->albedo_roughness, &targets->normal, &targets->emissive_metallic, &targets->object_id},
        &targets->depth);
    if (!gbuffer.ok()) return gbuffer.error();
    auto lit = gl::Framebuffer::create({&targets->colour}, &targets->depth);
    if (!lit.ok()) return lit.error();
    auto picture = gl::Framebuffer::create({&targets->colour, &targets->object_id}, &targets->depth);
    if (!picture.ok()) return picture.error();
    targets->gbuffer = std::move(*gbuffer);
    targets->lit = std::move(*lit);
    targets->picture = std::move(*picture);
    return targets;
}

}  // namespace lw
