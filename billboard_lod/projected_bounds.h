#pragma once
/// Where an object's box lies before a camera: what every decision about its billboard starts from.

#include <glm/glm.hpp>
#include <span>

#include "core/camera.h"
#include "scene/scene.h"

namespace lw {

/// A box as a camera sees it. NDC has x to the right and y up, -1 to 1 over the picture. Distances are -z_eye.
struct ProjectedBounds {
    glm::dvec2 ndc_min{0.0};
    glm::dvec2 ndc_max{0.0};
    glm::dvec3 eye_min{0.0};  ///< of its corners, eye space, metres
    glm::dvec3 eye_max{0.0};
    bool sound = false;    ///< the box is finite and not empty, and so are its corners in eye space
    bool usable = false;   ///< finite and wholly beyond the near plane; ndc_* mean nothing otherwise
    bool visible = false;  ///< overlaps the view; a box that cannot be projected counts unless it lies behind the eye

    [[nodiscard]] double nearest_m() const { return -eye_max.z; }
    [[nodiscard]] double farthest_m() const { return -eye_min.z; }
    /// Distance of the middle of the box's depth: d_cc = (d_1 + d_2) / 2 (seed 000, section 3.4).
    [[nodiscard]] double centre_m() const { return 0.5 * (nearest_m() + farthest_m()); }
    /// Length of the diagonal of the eye-space box: G_O (seed 000, section 3.3).
    [[nodiscard]] double size_m() const { return glm::length(eye_max - eye_min); }
};

/// The corners of `bounds_object` before `camera`. An empty or infinite box is neither usable nor visible. Pure, any
/// thread.
[[nodiscard]] ProjectedBounds projected(const scene::Bounds& bounds_object, const glm::dmat4& eye_from_object,
                                        const Camera& camera);

/// The same of points, finite and at least one, that stand for a box: for all that lies between them.
[[nodiscard]] ProjectedBounds projected(std::span<const glm::dvec3> points_object, const glm::dmat4& eye_from_object,
                                        const Camera& camera);

}  // namespace lw
