#pragma once
/// Which matrices can place an object.

#include <glm/glm.hpp>

namespace lw {

/// Can this place an object? Finite, affine (last row 0, 0, 0, 1). It may be singular: an object that vanishes.
/// Pure, any thread.
[[nodiscard]] bool is_placement(const glm::dmat4& world_from_object);

/// Can a surface be carried back into the object's own space? A placement whose axes have lengths and stand apart: what
/// they span is at least 1e-9 of the box of their lengths, so that the inverse keeps seven digits. Scale does not
/// matter (1e-100 to 1e100 on each axis), nor does mirroring. Pure, any thread.
[[nodiscard]] bool is_invertible_placement(const glm::dmat4& world_from_object);

}  // namespace lw
