#include "scene/chairs_materials.h"

#include <array>

#include "scene/city_textures.h"

namespace lw::scene {

namespace {

struct Recipe {
    const char* name;
    double texture_size_m;  ///< 0: no texture
    ColourImage (*texture)();
    float roughness;
    float metallic;
};

// In the order of ChairsMaterial.
constexpr std::array<Recipe, kChairsMaterialCount> kRecipes{{
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

double texture_size_m(ChairsMaterial material) {
    const double size = kRecipes[material].texture_size_m;
    return size > 0.0 ? size : 1.0;
}

void add_chairs_materials(Scene& scene) {
    for (const Recipe& recipe : kRecipes) {
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
    scene.materials[kScooterPaint].double_sided = true;  // thin panels, seen from behind too
    scene.materials[kTailLamp].emissive = {0.35f, 0.02f, 0.01f};
}

}  // namespace lw::scene
