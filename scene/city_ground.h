#pragma once
/// Roads, pavements, parks and the land around the town. The road's surface is y = 0.

#include "scene/city_layout.h"
#include "scene/mesh_builder.h"

namespace lw::scene {

/// A crossing with half of each street that leaves it: asphalt, zebras, dashes; origin on the crossing's centre.
[[nodiscard]] Mesh make_crossing();

/// Pavement with kerbs around two rows of lots and a green court; origin on the block's centre.
[[nodiscard]] Mesh make_block_ground();

/// The same size as a block: lawn, paths, a basin in the middle.
[[nodiscard]] Mesh make_park_ground();

/// Meadows and a ring of hills around a town of the given half size, metres, centred on its origin.
[[nodiscard]] Mesh make_country(double town_half_size_m, std::uint64_t seed);

}  // namespace lw::scene
