#pragma once
/// The textures that one draw fills.

#include <memory>

#include "core/result.h"
#include "gl/framebuffer.h"
#include "gl/texture.h"

namespace lw {

/// Belongs to one GL context and its thread.
struct RenderTargets {
    gl::Texture albedo_roughness;   ///< RGBA8: sqrt(albedo), roughness
    gl::Texture normal;             ///< RG16: octahedral
    gl::Texture emissive_metallic;  ///< RGBA8: sqrt(emissive), metallic
    gl::Texture object_id;          ///< R16UI
    gl::Texture depth;              ///< D32F, reversed infinite
    gl::Texture colour;             ///< SRGB8_ALPHA8, holds encoded values
    gl::Framebuffer gbuffer;        ///< the first four and depth
    gl::Framebuffer lit;            ///< colour, with depth to test against
    gl::Framebuffer picture;        ///< colour and object id, with depth: for what is drawn after the light

    /// Both sides of `size_px` >= 1.
    [[nodiscard]] static Result<std::unique_ptr<RenderTargets>> create(glm::ivec2 size_px);
};

}  // namespace lw
