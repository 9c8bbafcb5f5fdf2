#pragma once
/// The two eyes of a head-mounted display: where each is, what it sees, and one view that sees what both see.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/pose.h"
#include "core/result.h"

namespace lw {

enum class Eye : std::uint8_t { left = 0, right = 1 };
inline constexpr std::array<Eye, 2> kEyes{Eye::left, Eye::right};

/// "left" or "right".
[[nodiscard]] constexpr std::string_view name_of(Eye eye) { return eye == Eye::left ? "left" : "right"; }

/// One eye in the space of the head, which has the axes of an eye space and lies midway between the eyes.
struct EyeView {
    Pose head_from_eye;
    FovTangents fov;

    friend bool operator==(const EyeView&, const EyeView&) = default;
};

struct StereoRig {
    std::array<EyeView, 2> eyes;  ///< by Eye

    [[nodiscard]] const EyeView& eye(Eye which) const { return eyes[static_cast<std::size_t>(which)]; }

    friend bool operator==(const StereoRig&, const StereoRig&) = default;
};

/// What the left eye sees, for the right one: left and right change places.
[[nodiscard]] FovTangents mirrored(const FovTangents& fov);

/// Eyes `ipd_m` >= 0 apart on the head's x axis. The right eye mirrors the left one, in its field of view and in how it
/// is turned against the head. Pure, any thread.
/// @param left_turn  head_from_eye of the left eye's orientation, a unit quaternion; the identity for parallel eyes
[[nodiscard]] StereoRig mirrored_rig(double ipd_m, const FovTangents& left_fov,
                                     const glm::dquat& left_turn = {1.0, 0.0, 0.0, 0.0});

/// The camera of one eye. `display` gives size and near plane; its field of view and pose are not looked at. Pure.
[[nodiscard]] Camera eye_camera(const Camera& display, const EyeView& eye, const Pose& world_from_head);

/// Both eyes look the same way, side by side: things differ between them along the pixel rows alone.
/// @return what stands against it, "the eyes are turned against each other"; empty when nothing does. Pure.
[[nodiscard]] std::string_view why_not_rectified(const Camera& one, const Camera& other);

/// Distance from which on everything that an eye sees lies in the picture of the centre view. Nearer things at the
/// outer edge of an eye's picture are out of the frame: 0.3 m keeps what hands hold.
inline constexpr double kNearestCovered_m = 0.3;

/// One view from midway between the eyes, in the mean of their orientations, that holds what every eye sees from
/// `nearest_m` on. Its pose is relative to the head (head_from_view); it has at least as many pixels per tangent as
/// each eye has, in whole pixels (an odd number more than they have), and the near plane of `display`.
///
/// From midway each eye uncovers only what lies within half the eyes' distance behind an edge, on one side of it. A
/// view moved back until both frusta fit in its own needs no margin at its edges, but it moves along its own axis too,
/// which uncovers rings around everything near and shows everything smaller. In the city the margin costs 11 % of the
/// pixels and is worth 0.02 of SSIM to an eye's own render (docs/stereo.md).
///
/// @param back_m  how far behind the midway point, metres, >= 0
/// @return an error when the eyes are turned so far apart that no picture plane holds what both see
[[nodiscard]] Result<Camera> centre_view(const Camera& display, const StereoRig& rig,
                                         double nearest_m = kNearestCovered_m, double back_m = 0.0);

/// How far back the centre view has to be to hold both frusta at every distance: metres. Parallel eyes only; pure.
[[nodiscard]] double distance_back_m(const StereoRig& rig);

}  // namespace lw
