#include "client_renderer/texture_store.h"

#include <algorithm>
#include <bit>

namespace lw {

namespace {

GLenum gl_wrap(scene::TextureWrap wrap) {
    switch (wrap) {
        case scene::TextureWrap::clamp:
            return GL_CLAMP_TO_EDGE;
        case scene::TextureWrap::mirror:
            return GL_MIRRORED_REPEAT;
        case scene::TextureWrap::repeat:
            break;
    }
    return GL_REPEAT;
}

}  // namespace

TextureStore::TextureStore(const scene::Scene& scene)
    : has_image_(scene.images.size()), srgb_(scene.images.size()), linear_(scene.images.size()) {
    GLint largest_px = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest_px);
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        const ColourImage& pixels = scene.images[i].pixels;
        has_image_[i] = !pixels.empty() && std::max(pixels.width(), pixels.height()) <= largest_px;
    }
    for (const scene::Material& material : scene.materials) {
        upload(scene, material.base_colour_texture, true);
        upload(scene, material.emissive_texture, true);
        upload(scene, material.metallic_roughness_texture, false);
        upload(scene, material.normal_texture, false);
    }
}

void TextureStore::upload(const scene::Scene& scene, const scene::TextureUse& use, bool srgb) {
    if (use.image == scene::kNone) return;
    const auto image = static_cast<std::size_t>(use.image);
    if (!has_image_[image]) return;
    gl::Sampler& sampler = samplers_[{use.wrap_u, use.wrap_v, use.nearest}];
    if (!sampler) {
        sampler = gl::make_sampler(use.nearest ? GL_NEAREST_MIPMAP_LINEAR : GL_LINEAR_MIPMAP_LINEAR,
                                   use.nearest ? GL_NEAREST : GL_LINEAR, gl_wrap(use.wrap_u), gl_wrap(use.wrap_v));
    }
    gl::Texture& texture = (srgb ? srgb_ : linear_)[image];
    if (texture) return;
    const ColourImage& pixels = scene.images[image].pixels;
    const auto levels =
        static_cast<int>(std::bit_width(static_cast<unsigned>(std::max(pixels.width(), pixels.height()))));
    texture = gl::Texture{pixels.size_px(), srgb ? GLenum{GL_SRGB8_ALPHA8} : GLenum{GL_RGBA8}, levels};
    texture.upload(GL_RGBA, GL_UNSIGNED_BYTE, pixels.pixels().data());
    glGenerateTextureMipmap(texture.id());
}

void TextureStore::bind(const scene::TextureUse& use, bool srgb, int unit) const {
    const auto image = static_cast<std::size_t>(use.image);
    glBindTextureUnit(static_cast<GLuint>(unit), (srgb ? srgb_ : linear_)[image].id());
    glBindSampler(static_cast<GLuint>(unit), samplers_.at({use.wrap_u, use.wrap_v, use.nearest}).id());
}

}  // namespace lw
