#pragma once
/// The scene's images as textures with mipmaps, and the samplers its materials use.

#include <map>
#include <tuple>
#include <vector>

#include "gl/texture.h"
#include "scene/scene.h"

namespace lw {

/// Belongs to one GL context and its thread.
class TextureStore {
public:
    /// Uploads what the materials use: as sRGB where it is a colour, as linear values else, both where used as both.
    explicit TextureStore(const scene::Scene& scene);

    /// Per image of the scene: is there anything to sample? An image without pixels is not.
    [[nodiscard]] const std::vector<bool>& has_image() const { return has_image_; }

    /// Binds the image and a sampler for `use` to a texture unit. `use` names an uploaded image.
    void bind(const scene::TextureUse& use, bool srgb, int unit) const;

private:
    using SamplerKey = std::tuple<scene::TextureWrap, scene::TextureWrap, bool>;

    void upload(const scene::Scene& scene, const scene::TextureUse& use, bool srgb);

    std::vector<bool> has_image_;
    std::vector<gl::Texture> srgb_;  ///< by image; empty where not used so
    std::vector<gl::Texture> linear_;
    std::map<SamplerKey, gl::Sampler> samplers_;
};

}  // namespace lw
