#include "core/camera.h"

#include <cmath>
#include <numbers>

namespace lw {

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
