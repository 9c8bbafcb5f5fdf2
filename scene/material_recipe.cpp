#include "scene/material_recipe.h"

namespace lw::scene {

double texture_size_m(const MaterialRecipe& recipe) {
    return recipe.texture_size_m > 0.0 ? recipe.texture_size_m : 1.0;
}

void add_materials(Scene& scene, std::span<const MaterialRecipe> recipes) {
    for (const MaterialRecipe& recipe : recipes) {
        Material material;
        material.name = recipe.name;
        material.roughness = recipe.roughness;
        material.metallic = recipe.metallic;
        if (recipe.texture != nullptr) {
            material.base_colour_texture.image = static_cast<int>(scene.images.size());
            scene.images.push_back({recipe.name, recipe.texture()});
        }
        scene.materials.push_back(std::move(material));
    }
}

}  // namespace lw::scene
