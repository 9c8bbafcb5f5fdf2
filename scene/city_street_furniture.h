#pragma once
/// What stands on the pavements. Origin on the ground; +Z of each piece points to the street unless said otherwise.

#include <vector>

#include "scene/mesh_builder.h"

namespace lw::scene {

inline constexpr double kLampHeight_m = 5.1;
inline constexpr double kLampReach_m = 1.15;  ///< of the lantern towards the street
inline constexpr double kRailModule_m = 2.0;  ///< length of a piece of guard rail, fence or hedge, along x
inline constexpr double kWireHeight_m = 7.9;  ///< of the upper wires at a pole

[[nodiscard]] Mesh make_lamp_post();
[[nodiscard]] Mesh make_guard_rail();                ///< with single bars, along x
[[nodiscard]] Mesh make_iron_fence();                ///< garden fence on a low wall, along x
[[nodiscard]] Mesh make_utility_pole();              ///< carries wires along x, arms along z
[[nodiscard]] Mesh make_wire_span(double length_m);  ///< from one pole at the origin to one at +x, sagging
[[nodiscard]] Mesh make_service_drop();              ///< wires from a pole to a house behind it (-z)
[[nodiscard]] Mesh make_span_lamp(double width_m);   ///< a lamp hanging from a wire across a street, along x, centred
[[nodiscard]] Mesh make_bench();
[[nodiscard]] Mesh make_litter_bin();
[[nodiscard]] Mesh make_bollard();
[[nodiscard]] Mesh make_post_box();
[[nodiscard]] Mesh make_street_sign();
[[nodiscard]] Mesh make_planter(std::uint64_t seed);
[[nodiscard]] Mesh make_cafe_table();  ///< with two chairs and a parasol
[[nodiscard]] Mesh make_bicycle();     ///< leaning on a stand, along x
[[nodiscard]] Mesh make_tree_pit();

}  // namespace lw::scene
