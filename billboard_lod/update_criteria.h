#pragma once
/// When is a billboard too wrong to be kept? By the three angles of seed 000, section 3.6, or by the pixels it is off.

#include <array>
#include <glm/glm.hpp>

#include "billboard_lod/billboard_plane.h"
#include "core/camera.h"

namespace lw {

/// Thresholds of the three heuristics. The third runs from 0 to 180 like the others, for a change of 0 to 100 %.
struct UpdateThresholds {
    double view_deg = 2.5;     ///< theta: the picture's horizontal has turned
    double lateral_deg = 1.0;  ///< phi: the eye has moved sideways
    double distance = 4.5;     ///< psi: the eye has come nearer or gone away
};

/// The three heuristics' values.
struct UpdateScores {
    double view_deg = 0.0;
    double lateral_deg = 0.0;
    double distance = 0.0;

    /// The weighted sum, 1:1:1 in units of the thresholds: at 1 an update is due (seed 000, section 3.7.1).
    [[nodiscard]] double weighted(const UpdateThresholds& thresholds) const {
        return view_deg / thresholds.view_deg + lateral_deg / thresholds.lateral_deg + distance / thresholds.distance;
    }
};

/// theta: angle between two horizontals of a picture, degrees in [0, 180]. Neither is zero. Pure.
[[nodiscard]] double view_angle_deg(const glm::dvec3& horizontal_then, const glm::dvec3& horizontal_now);

/// phi: angle between two ways from the eye to the billboard's centre, degrees in [0, 180]. Neither is zero. Pure.
[[nodiscard]] double lateral_angle_deg(const glm::dvec3& to_centre_then, const glm::dvec3& to_centre_now);

/// psi = 180 * clamp(| |w| / |w'| - 1 |, 0, 1). Neither is zero. Pure.
[[nodiscard]] double distance_score(const glm::dvec3& to_centre_then, const glm::dvec3& to_centre_now);

/// A billboard as it was drawn: in the eye space of its drawing.
struct DrawnBillboard {
    TexelGrid grid;
    double nearest_m = 0.0;  ///< of what it shows
    double farthest_m = 0.0;
    double plane_m = 0.0;  ///< distance of its plane
};

/// Largest distance in pixels between where a flat billboard shows a point and where the point belongs, over the
/// corners of what it can hold: its window at its nearest and farthest distance. Its quad has its centre where it was
/// and the axes of the picture. `eye_now_from_eye_drawn` is rigid. Infinite when a corner lies before the near plane.
/// Pure.
[[nodiscard]] double flat_error_px(const DrawnBillboard& billboard, const glm::dmat4& eye_now_from_eye_drawn,
                                   const Camera& camera);

/// What is left when the billboard's own depth moves its pixels: points land where they belong, but what its eye did
/// not see is missing. That is as wide as two surfaces on one of its rays are apart now, pixels: of two points anywhere
/// in its depth the mean, a third of what its nearest and its farthest point would be apart. Plus what its texels are
/// larger than pixels by. Infinite when a corner lies before the near plane. Pure.
[[nodiscard]] double warped_error_px(const DrawnBillboard& billboard, const glm::dmat4& eye_now_from_eye_drawn,
                                     const Camera& camera);

}  // namespace lw
