#pragma once
/// Materials of the built-in scenes as rows of a table.

#include <span>

#include "core/image.h"
#include "scene/scene.h"

namespace lw::scene {

struct MaterialRecipe {
    const char* name;
    double texture_size_m;  ///< edge of what one copy of the texture covers; 0: no texture
    ColourImage (*texture)();
    float roughness;
    float metallic;
};

/// Of texture coordinates: 1 m where there is no texture.
[[nodiscard]] double texture_size_m(const MaterialRecipe& recipe);

/// Appends a material, and its image where it has one, for each row.
void add_materials(Scene& scene, std::span<const MaterialRecipe> recipes);

}  // namespace lw::scene
