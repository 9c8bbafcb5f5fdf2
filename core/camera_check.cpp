#include "core/camera_check.h"

#include <cmath>

#include "core/image_io.h"

namespace lw {
namespace {

constexpr double kMaxTangent = 1e4;
constexpr double kLeastTangents = 1e-6;  // one pixel of a telescope; 1 degree is 0.017
constexpr double kLeastNear_m = 1e-9;
constexpr double kMaxNumber = 1e12;      // metres beyond this are not meant
constexpr double kUnitTolerance = 1e-3;  // three decimals, as people type quaternions

}  // namespace

std::string_view problem_of(const Camera& camera) {
    const FovTangents& fov = camera.fov;
    for (const double tangent : {fov.left, fov.right, fov.down, fov.up}) {
        if (!(std::abs(tangent) <= kMaxTangent)) return "a tangent in fov_tangents is not usable";
    }
    if (!(fov.left < fov.right && fov.down < fov.up)) return "fov_tangents are not in order left < right, down < up";
    if (!(fov.right - fov.left >= kLeastTangents && fov.up - fov.down >= kLeastTangents)) {
        return "fov_tangents are less than 1e-6 apart";
    }
    if (!(camera.near_m > 0.0 && camera.near_m <= kMaxNumber)) return "near_m is not above 0";
    if (camera.near_m < kLeastNear_m) return "near_m is below 1e-9";
    const glm::ivec2 size = camera.size_px;
    if (size.x < 1 || size.y < 1 || size.x > kMaxImageSidePx || size.y > kMaxImageSidePx) {
        return "size_px is not usable";
    }
    const auto pose = sanitised(camera.world_from_eye);
    if (!pose || std::abs(glm::length(camera.world_from_eye.orientation) - 1.0) > kUnitTolerance) {
        return "world_from_eye is not a rigid pose";
    }
    const glm::dvec3 position_m = glm::abs(pose->position_m);
    if (!(position_m.x <= kMaxNumber && position_m.y <= kMaxNumber && position_m.z <= kMaxNumber)) {
        return "world_from_eye is beyond 1e12 m";
    }
    return {};
}

}  // namespace lw
