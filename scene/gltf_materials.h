#pragma once
/// glTF materials, textures and images -> Material and TextureImage.

#include <vector>

#include "scene/gltf_source.h"
#include "scene/scene.h"

namespace lw::scene {

/// Fills scene.materials (one per glTF material, same order) and scene.images (those that a material uses and that can
/// be decoded). An image that cannot be read leaves its uses without a texture, with one warning.
void import_materials(GltfSource& source, Scene& scene);

/// The TEXCOORD set that a material's vertices carry: our vertices have one, so it is the base colour's, or that of the
/// first texture there is. kNone: set 0.
[[nodiscard]] int uv_set_of(const GltfSource& source, int material);

}  // namespace lw::scene
