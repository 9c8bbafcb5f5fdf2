#pragma once
/// Cars of a few types and colours. Origin on the ground in the middle, front towards +Z, 3.6-5 m long.

#include <vector>

#include "scene/mesh_builder.h"

namespace lw::scene {

[[nodiscard]] std::vector<Mesh> make_vehicles();

inline constexpr double kVehicleHalfLength_m = 2.5;  ///< of the longest
inline constexpr double kVehicleHalfWidth_m = 1.0;

}  // namespace lw::scene
