#pragma once
/// The built-in office building: storeys of furnished rooms on corridors, with doors and windows, as cells and portals.

#include <cstdint>

#include "scene/scene.h"

namespace lw::scene {

struct RoomsParameters {
    int rooms = 240;  ///< 4..2000; storeys of up to 120
    int movers = 8;   ///< trolleys that drive along the corridors, 0..64
    std::uint64_t seed = 1;
};

inline constexpr int kMaxRooms = 2000;
inline constexpr int kMaxTrolleys = 64;

/// Equal parameters give equal scenes, bit for bit. Finished, with cells. The viewer starts in a corridor.
[[nodiscard]] Scene make_rooms(const RoomsParameters& parameters);

}  // namespace lw::scene
