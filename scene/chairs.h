#pragma once
/// The built-in stress test: many curved chairs and scooters strewn over a square floor, every one a full mesh.

#include <cstdint>

#include "core/result.h"
#include "scene/scene.h"

namespace lw::scene {

struct ChairsParameters {
    int chairs = 500;    ///< 0..20000
    int scooters = 500;  ///< 0..20000
    int movers = 0;      ///< of the objects, so many turn on the spot; at most chairs + scooters
    std::uint64_t seed = 1;
};

inline constexpr int kMaxChairs = 20000;

/// Positions are random on the floor, rotations random about all three axes; every object is lifted until it just
/// touches the floor. Equal parameters give equal scenes, bit for bit. More movers than objects are an error. Finished.
[[nodiscard]] Result<Scene> make_chairs(const ChairsParameters& parameters);

/// Side of the floor that so many objects are strewn over, metres. Pure.
[[nodiscard]] double chairs_floor_side_m(int objects);

}  // namespace lw::scene
