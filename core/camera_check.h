#pragma once
/// Which cameras can be.

#include <string_view>

#include "core/camera.h"

namespace lw {

/// What keeps a camera from being used, or nothing: finite numbers, tangents within 1e4 (89.99 degrees) and in order
/// left < right, down < up, at least 1e-6 apart, near plane from 1e-9 to 1e12 m, position within 1e12 m, unit
/// quaternion (within 1e-3), both sides of the size within 1..kMaxImageSidePx. Within these limits no matrix of a
/// camera overflows a float. Pure, any thread.
[[nodiscard]] std::string_view problem_of(const Camera& camera);

}  // namespace lw
