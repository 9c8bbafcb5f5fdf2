#pragma once
/// Trees: trunk, branches, and leaves as single bent cards around a dark inner crown. Origin at the foot.

#include <vector>

#include "scene/mesh_builder.h"

namespace lw::scene {

/// A few trees of different size and shape, 5-11 m high; the first ones fit between a kerb and a house.
[[nodiscard]] std::vector<Mesh> make_trees(std::uint64_t seed);
inline constexpr int kStreetTrees = 3;  ///< of make_trees(), at its beginning

/// A clipped hedge, 2 m long along x, 1.1 m high.
[[nodiscard]] Mesh make_hedge(std::uint64_t seed);

}  // namespace lw::scene
