#include "core/camera.h"

#include <cmath>
#include <numbers>

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

FovTangents FovTangents::symmetric(double vertical_rad, double aspect) {
    const double up = std::tan(0.5 * vertical_rad);
    return {-up * aspect, up * aspect, -up, up};
}

Transform<SourceEye, SourcePx> source_eye_from_source_px(const Camera& source) {
    const FovTangents& fov = source.fov;
    glm::dmat4 m{0.0};  // columns: x_px, y_px, 1, depth
    m[0][0] = (fov.right - fov.left) / source.size_px.x;
    m[1][1] = (fov.down - fov.up) / source.size_px.y;
    m[2] = glm::dvec4{fov.left, fov.up, -1.0, 0.0};
    m[3][3] = 1.0 / source.near_m;
    return {m};
}

Transform<TargetClip, TargetEye> target_clip_from_target_eye(const Camera& target) {
    const FovTangents& fov = target.fov;
    const double width = fov.right - fov.left;
    const double height = fov.up - fov.down;
    glm::dmat4 m{0.0};  // columns: x, y, z, w of the eye space
    m[0][0] = 2.0 / width;
    m[1][1] = 2.0 / height;
    m[2] = glm::dvec4{(fov.right + fov.left) / width, (fov.up + fov.down) / height, 0.0, -1.0};
    m[3][2] = target.near_m;
    return {m};
}

Transform<TargetPx, TargetClip> target_px_from_target_clip(const Camera& target) {
    const double half_width = 0.5 * target.size_px.x;
    const double half_height = 0.5 * target.size_px.y;
    glm::dmat4 m{1.0};
    m[0][0] = half_width;
    m[1][1] = -half_height;
    m[3] = glm::dvec4{half_width, half_height, 0.0, 1.0};
    return {m};
}

double pixels_per_degree(const Camera& camera) {
    return std::numbers::pi / 180.0 * camera.size_px.y / (camera.fov.up - camera.fov.down);
}

}  // namespace lw
