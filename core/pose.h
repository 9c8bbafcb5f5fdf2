#pragma once
/// Rigid poses of heads and cameras: position and orientation, interpolated on the sphere.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

#include "core/transform.h"

namespace lw {

/// world_from_eye as position (metres, world) and unit quaternion. glm::dquat's constructor takes (w, x, y, z).
struct Pose {
    glm::dvec3 position_m{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};

    friend bool operator==(const Pose&, const Pose&) = default;
};

/// The pose with its orientation normalised; nothing when a component is not finite or the quaternion is too short
/// (norm below 1e-6) to have a direction. Pure, any thread.
[[nodiscard]] std::optional<Pose> sanitised(const Pose& pose);

/// world_from_local as a matrix. `pose` has a unit quaternion. Pure, any thread.
[[nodiscard]] glm::dmat4 matrix_of(const Pose& pose);

/// local_from_world as a matrix: transposed rotation, no general inverse. Pure, any thread.
[[nodiscard]] glm::dmat4 inverse_matrix_of(const Pose& pose);

/// Position linear, orientation by spherical interpolation along the shorter arc; `t` may lie outside [0, 1], which
/// extrapolates at constant linear and angular velocity. Pure, any thread.
[[nodiscard]] Pose interpolate(const Pose& a, const Pose& b, double t);

/// Rotation vector (axis times angle, radians, length at most pi) of a unit quaternion, along the shorter arc. Tiny
/// angles keep their digits. Pure, any thread.
[[nodiscard]] glm::dvec3 rotation_vector(glm::dquat q);

/// The unit quaternion that turns about `rotation` by its length, radians. Pure, any thread.
[[nodiscard]] glm::dquat from_rotation_vector(const glm::dvec3& rotation);

/// Angle of the rotation that leads from a to b, in [0, pi]. Accurate for tiny angles too. Pure, any thread.
[[nodiscard]] double angle_between_rad(const glm::dquat& a, const glm::dquat& b);

/// `outer * inner`: the pose of something given in the frame of `outer`. Pure, any thread.
[[nodiscard]] Pose compose(const Pose& outer, const Pose& inner);

/// The inverse rigid motion. Pure, any thread.
[[nodiscard]] Pose inverse(const Pose& pose);

}  // namespace lw
