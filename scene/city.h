#pragma once
/// The built-in town: a street grid of instanced houses, trees and furniture, and cars that drive around its blocks.

#include <cstdint>
#include <optional>

#include "core/result.h"
#include "scene/scene.h"

namespace lw::scene {

struct CityParameters {
    int buildings = 120;        ///< 1..100000
    std::optional<int> movers;  ///< cars, at most as many as keep a safe gap; unset: 32, fewer in a hamlet
    std::uint64_t seed = 1;
};

inline constexpr int kMaxCityBuildings = 100000;

/// Equal parameters give equal scenes, bit for bit. More cars than the streets hold are an error. Finished.
[[nodiscard]] Result<Scene> make_city(const CityParameters& parameters);

}  // namespace lw::scene
