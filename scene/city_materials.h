#pragma once
/// What the city is made of: its materials, in the order of Scene::materials.

#include "scene/scene.h"

namespace lw::scene {

enum CityMaterial : int {
    kPlaster,
    kBrick,
    kStone,
    kRoofTile,
    kRoofFelt,
    kGlass,
    kPaint,  ///< painted wood and metal: frames, doors, railings
    kWood,
    kIron,
    kAsphalt,
    kPaving,
    kGrass,
    kHill,  ///< far meadows, no texture
    kRoadPaint,
    kBark,
    kLeaf,
    kCarPaint,
    kRubber,
    kLamp,  ///< glows
    kCityMaterialCount,
};

/// Metres that one repeat of a material's texture covers.
[[nodiscard]] double texture_size_m(CityMaterial material);

/// Fills Scene::images and Scene::materials. Deterministic.
void add_city_materials(Scene& scene);

}  // namespace lw::scene
