#include "scene/city_materials.h"

#include <array>

#include "scene/city_textures.h"
#include "scene/material_recipe.h"

namespace lw::scene {

namespace {

// In the order of CityMaterial.
constexpr std::array<MaterialRecipe, kCityMaterialCount> kRecipes{{
    {"plaster", 3.2, plaster_texture, 0.92f, 0.0f},
    {"brick", 1.92, brick_texture, 0.9f, 0.0f},
    {"stone", 1.5, stone_texture, 0.85f, 0.0f},
    {"roof tile", 2.4, roof_tile_texture, 0.8f, 0.0f},
    {"roof felt", 4.0, roof_felt_texture, 0.95f, 0.0f},
    {"glass", 0.0, nullptr, 0.12f, 0.0f},
    {"paint", 0.0, nullptr, 0.6f, 0.0f},
    {"wood", 1.2, wood_texture, 0.75f, 0.0f},
    {"iron", 0.0, nullptr, 0.55f, 0.3f},
    {"asphalt", 4.0, asphalt_texture, 0.95f, 0.0f},
    {"paving", 3.0, paving_texture, 0.9f, 0.0f},
    {"grass", 3.0, grass_texture, 0.95f, 0.0f},
    {"hill", 0.0, nullptr, 0.95f, 0.0f},
    {"road paint", 0.0, nullptr, 0.8f, 0.0f},
    {"bark", 0.8, bark_texture, 0.95f, 0.0f},
    {"leaf", 0.0, nullptr, 0.85f, 0.0f},
    {"car paint", 0.0, nullptr, 0.3f, 0.0f},
    {"rubber", 0.0, nullptr, 0.9f, 0.0f},
    {"lamp", 0.0, nullptr, 0.5f, 0.0f},
}};

}  // namespace

double texture_size_m(CityMaterial material) { return texture_size_m(kRecipes[material]); }

void add_city_materials(Scene& scene) {
    add_materials(scene, kRecipes);
    scene.materials[kLeaf].double_sided = true;
    scene.materials[kLamp].emissive = {0.9f, 0.75f, 0.45f};
}

}  // namespace lw::scene
