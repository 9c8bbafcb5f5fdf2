#pragma once
/// Materials of the scene of chairs and scooters, by fixed index.

#include "scene/scene.h"

namespace lw::scene {

enum ChairsMaterial : int {
    kBentWood,
    kFabric,
    kFelt,
    kScooterPaint,
    kChrome,
    kTyre,
    kLeather,
    kLens,
    kTailLamp,
    kFloor,
    kChairsMaterialCount
};

/// Metres that one repeat of the material's texture covers; 1 without one.
[[nodiscard]] double texture_size_m(ChairsMaterial material);

void add_chairs_materials(Scene& scene);

}  // namespace lw::scene
