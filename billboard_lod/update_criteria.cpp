#include "billboard_lod/update_criteria.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lw {

namespace {

constexpr double kDegPerRad = 180.0 / 3.14159265358979323846;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Mean distance of two points that lie anywhere in a range, as a share of the range.
constexpr double kMeanApart = 1.0 / 3.0;

// By the arc tangent: exact also for tiny angles, where the arc cosine loses half its digits.
double angle_deg(const glm::dvec3& a, const glm::dvec3& b) {
    return kDegPerRad * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// Pixels per unit of tangent.
glm::dvec2 px_per_tangent(const Camera& camera) {
    return {camera.size_px.x / (camera.fov.right - camera.fov.left),
            camera.size_px.y / (camera.fov.up - camera.fov.down)};
}

glm::dvec2 tangents(const glm::dvec3& eye) { return glm::dvec2{eye} / -eye.z; }

/// The middle and the corners of a window, as tangents.
std::array<glm::dvec2, 5> rays_of(const FovTangents& window) {
    return {{{0.5 * (window.left + window.right), 0.5 * (window.down + window.up)},
             {window.left, window.down},
             {window.right, window.down},
             {window.left, window.up},
             {window.right, window.up}}};
}

}  // namespace

double view_angle_deg(const glm::dvec3& horizontal_then, const glm::dvec3& horizontal_now) {
    return angle_deg(horizontal_then, horizontal_now);
}

double lateral_angle_deg(const glm::dvec3& to_centre_then, const glm::dvec3& to_centre_now) {
    return angle_deg(to_centre_then, to_centre_now);
}

double distance_score(const glm::dvec3& to_centre_then, const glm::dvec3& to_centre_now) {
    const double ratio = glm::length(to_centre_then) / glm::length(to_centre_now);
    return 180.0 * std::clamp(std::abs(ratio - 1.0), 0.0, 1.0);
}

double flat_error_px(const DrawnBillboard& billboard, const glm::dmat4& eye_now_from_eye_drawn, const Camera& camera) {
    const FovTangents window = billboard.grid.window();
    const BillboardPlane plane = plane_of(window, billboard.plane_m);
    const glm::dvec3 centre_now{eye_now_from_eye_drawn * glm::dvec4{plane.centre_eye, 1.0}};
    if (-centre_now.z <= camera.near_m) return kInfinity;
    double worst_px = 0.0;
    for (const glm::dvec2& ray : rays_of(window)) {
        // The quad shows this ray at the same offset from its centre, in the plane of the picture.
        const glm::dvec2 offset_m = ray * billboard.plane_m - glm::dvec2{plane.centre_eye};
        const glm::dvec2 shown = tangents(centre_now + glm::dvec3{offset_m, 0.0});
        for (const double distance_m : {billboard.nearest_m, billboard.farthest_m}) {
            const glm::dvec3 belongs{eye_now_from_eye_drawn * glm::dvec4{ray * distance_m, -distance_m, 1.0}};
            if (-belongs.z <= camera.near_m) return kInfinity;
            worst_px = std::max(worst_px, glm::length((shown - tangents(belongs)) * px_per_tangent(camera)));
        }
    }
    return worst_px;
}

double warped_error_px(const DrawnBillboard& billboard, const glm::dmat4& eye_now_from_eye_drawn,
                       const Camera& camera) {
    const glm::dvec2 scale = px_per_tangent(camera);
    double widest_px = 0.0;
    double nearest_now_m = kInfinity;
    for (const glm::dvec2& ray : rays_of(billboard.grid.window())) {
        const auto now = [&](double distance_m) {
            return glm::dvec3{eye_now_from_eye_drawn * glm::dvec4{ray * distance_m, -distance_m, 1.0}};
        };
        const glm::dvec3 front = now(billboard.nearest_m);
        const glm::dvec3 back = now(billboard.farthest_m);
        nearest_now_m = std::min({nearest_now_m, -front.z, -back.z});
        if (nearest_now_m <= camera.near_m) return kInfinity;
        widest_px = std::max(widest_px, glm::length((tangents(front) - tangents(back)) * scale));
    }
    const double texel_px = billboard.grid.per_texel.x * scale.x * (billboard.nearest_m / nearest_now_m);
    return kMeanApart * widest_px + std::max(0.0, texel_px - 1.0);
}

}  // namespace lw
