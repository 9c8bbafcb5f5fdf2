#pragma once
/// A camera's picture as pixels and as directions.

#include <glm/glm.hpp>

#include "core/camera.h"

namespace lw {

/// Pixels of the picture. Pure, any thread.
[[nodiscard]] inline double pixel_count(const Camera& camera) {
    return static_cast<double>(camera.size_px.x) * camera.size_px.y;
}

/// The same camera at another pose. Pure, any thread.
[[nodiscard]] Camera at_pose(Camera camera, const Pose& pose);

/// A direction of the picture in world space, 1 long along the camera's axis; `x` and `y` in [0, 1] from the picture's
/// upper left corner. Pure, any thread.
[[nodiscard]] glm::dvec3 direction_at(const Camera& camera, double x, double y);

/// Whether a camera sees a direction of world space, of any length > 0. Pure, any thread.
[[nodiscard]] bool sees(const Camera& camera, const glm::dvec3& direction_world);

}  // namespace lw
