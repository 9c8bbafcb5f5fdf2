#include "scene/chairs_materials.h"

#include <array>

#include "scene/city_textures.h"
#include "scene/material_recipe.h"

namespace lw::scene {

namespace {

// In the order of ChairsMaterial.
constexpr std::array<MaterialRecipe, kChairsMaterialCount> kRecipes{{
    {"bent wood", 1.2, wood_texture, 0.45f, 0.0f},
    {"fabric", 0.0, nullptr, 0.95f, 0.0f},
    {"felt", 0.0, nullptr, 0.95f, 0.0f},
    {"scooter paint", 0.0, nullptr, 0.3f, 0.0f},
    {"chrome", 0.0, nullptr, 0.25f, 1.0f},
    {"tyre", 0.0, nullptr, 0.9f, 0.0f},
    {"leather", 0.0, nullptr, 0.6f, 0.0f},
    {"lens", 0.0, nullptr, 0.15f, 0.0f},
    {"tail lamp", 0.0, nullptr, 0.4f, 0.0f},
    {"floor", 3.0, paving_texture, 0.9f, 0.0f},
}};

}  // namespace

double texture_size_m(ChairsMaterial material) { return texture_size_m(kRecipes[material]); }

void add_chairs_materials(Scene& scene) {
    add_materials(scene, kRecipes);
    scene.materials[kScooterPaint].double_sided = true;  // thin panels, seen from behind too
    scene.materials[kTailLamp].emissive = {0.35f, 0.02f, 0.01f};
}

}  // namespace lw::scene
