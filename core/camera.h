#pragma once
/// An asymmetric pinhole camera with reversed, infinite depth: depth = near_m / distance_m, 1 at the near plane, 0 at
/// infinity and for background. distance_m = -z_eye, not the length of the ray.

#include <glm/glm.hpp>

#include "core/pose.h"
#include "core/transform.h"

namespace lw {

/// Field of view as signed tangents; left and down are negative for an ordinary view.
struct FovTangents {
    double left = -1.0;
    double right = 1.0;
    double down = -1.0;
    double up = 1.0;

    /// Symmetric about the axis. `vertical_rad` in (0, pi), `aspect` = width / height.
    [[nodiscard]] static FovTangents symmetric(double vertical_rad, double aspect);

    friend bool operator==(const FovTangents&, const FovTangents&) = default;
};

/// Where a picture was drawn from, or is shown from.
struct Camera {
    Pose world_from_eye;
    FovTangents fov;
    double near_m = 0.05;
    glm::ivec2 size_px{0};

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Rays of source pixels: (x_px, y_px, 1, depth) -> (ray_x, ray_y, -1, depth / near_m). No matrix inverse is involved,
/// and background (depth 0) becomes a direction, so sky rotates and never translates. Pure, any thread.
[[nodiscard]] Transform<SourceEye, SourcePx> source_eye_from_source_px(const Camera& source);

/// GL clip coordinates for glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE): w = -z_eye, z = near_m. Pure, any thread.
[[nodiscard]] Transform<TargetClip, TargetEye> target_clip_from_target_eye(const Camera& target);

/// Viewport: NDC x right, y up -> pixels from the top-left corner, depth unchanged. Pure, any thread.
[[nodiscard]] Transform<TargetPx, TargetClip> target_px_from_target_clip(const Camera& target);

/// True pixels per degree at the image centre: (pi / 180) * height_px / (tan_up - tan_down). Pure, any thread.
[[nodiscard]] double pixels_per_degree(const Camera& camera);

/// Distance of a depth value, metres; infinity for background (0). Pure, any thread.
[[nodiscard]] inline double distance_m(double depth, double near_m) { return near_m / depth; }

}  // namespace lw
