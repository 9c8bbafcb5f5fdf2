#pragma once
/// Furniture of the built-in office building. Object space: metres, on the floor at y = 0, its back at z = 0 towards -Z
/// where it has one, so that it stands with its back to a wall.

#include <vector>

#include "scene/scene.h"

namespace lw::scene {

enum class Furniture : std::uint8_t {
    desk,
    office_chair,
    bookcase,
    filing_cabinet,
    meeting_table,
    chair,
    sofa,
    low_table,
    plant,
    floor_lamp,
    ceiling_lamp,  ///< hangs from y = 0
    radiator,
    waste_bin,
    picture,  ///< on a wall, middle at y = 0
    door_leaf,
    stairs,
    trolley,
    count,
};

/// One mesh for each, in the order of the enum.
[[nodiscard]] std::vector<Mesh> make_furniture(std::uint64_t seed);

}  // namespace lw::scene
