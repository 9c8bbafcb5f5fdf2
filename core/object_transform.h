#pragma once
/// The placement of one mover at one time.

#include <cstdint>
#include <glm/glm.hpp>

namespace lw {

/// Object id in frames: 0 is sky and the static world, 1..65535 are movers.
using ObjectId = std::uint16_t;

struct ObjectTransform {
    ObjectId id = 0;
    glm::dmat4 world_from_object{1.0};  ///< affine: last row (0, 0, 0, 1)

    friend bool operator==(const ObjectTransform&, const ObjectTransform&) = default;
};

/// Can this place an object? Finite, affine (last row 0, 0, 0, 1). It may be singular: an object that vanishes.
/// Pure, any thread.
[[nodiscard]] bool is_placement(const glm::dmat4& world_from_object);

/// Can a surface be carried back into the object's own space? A placement whose axes have lengths and stand apart: what
/// they span is at least 1e-9 of the box of their lengths, so that the inverse keeps seven digits. Scale does not
/// matter (1e-100 to 1e100 on each axis), nor does mirroring. Pure, any thread.
[[nodiscard]] bool is_invertible_placement(const glm::dmat4& world_from_object);

}  // namespace lw
