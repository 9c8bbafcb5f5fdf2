#include "billboard_lod/projected_bounds.h"

#include <array>
#include <cmath>

namespace lw {

namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

ProjectedBounds projected(const scene::Bounds& bounds_object, const glm::dmat4& eye_from_object, const Camera& camera) {
    if (bounds_object.empty() || !finite(bounds_object.min) || !finite(bounds_object.max)) return {};
    std::array<glm::dvec3, 8> corners;
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        corners[corner] = {(corner & 1) != 0 ? bounds_object.max.x : bounds_object.min.x,
                           (corner & 2) != 0 ? bounds_object.max.y : bounds_object.min.y,
                           (corner & 4) != 0 ? bounds_object.max.z : bounds_object.min.z};
    }
    return projected(corners, eye_from_object, camera);
}

ProjectedBounds projected(std::span<const glm::dvec3> points_object, const glm::dmat4& eye_from_object,
                          const Camera& camera) {
    ProjectedBounds result;
    result.ndc_min = glm::dvec2{1e300};
    result.ndc_max = glm::dvec2{-1e300};
    result.eye_min = glm::dvec3{1e300};
    result.eye_max = glm::dvec3{-1e300};
    const FovTangents& fov = camera.fov;
    const glm::dvec2 middle{0.5 * (fov.left + fov.right), 0.5 * (fov.down + fov.up)};
    const glm::dvec2 half{0.5 * (fov.right - fov.left), 0.5 * (fov.up - fov.down)};
    bool outside[4] = {true, true, true, true};  // all of them left of, right of, below, above the view
    for (const glm::dvec3& object : points_object) {
        const glm::dvec3 eye{eye_from_object * glm::dvec4{object, 1.0}};
        if (!finite(eye)) return {};
        result.eye_min = glm::min(result.eye_min, eye);
        result.eye_max = glm::max(result.eye_max, eye);
        const double distance_m = -eye.z;
        outside[0] = outside[0] && eye.x < fov.left * distance_m;
        outside[1] = outside[1] && eye.x > fov.right * distance_m;
        outside[2] = outside[2] && eye.y < fov.down * distance_m;
        outside[3] = outside[3] && eye.y > fov.up * distance_m;
        const glm::dvec2 ndc = (glm::dvec2{eye} / distance_m - middle) / half;
        result.ndc_min = glm::min(result.ndc_min, ndc);
        result.ndc_max = glm::max(result.ndc_max, ndc);
    }
    const bool behind = result.farthest_m() <= camera.near_m;
    result.visible = !behind && !outside[0] && !outside[1] && !outside[2] && !outside[3];
    result.sound = true;
    result.usable = result.nearest_m() > camera.near_m;
    return result;
}

}  // namespace lw
