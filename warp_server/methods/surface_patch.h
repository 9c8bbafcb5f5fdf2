#pragma once
/// A piece of plane of one object: from a place in the target to the place in the source, exactly.

#include <glm/glm.hpp>

#include "warp_server/methods/object_matrices.h"

namespace lw {

/// Depth over the source, around a pixel: depth + gradient * (place - origin).
struct SourcePlane {
    float origin_x_px = 0.0F;
    float origin_y_px = 0.0F;
    float depth = 0.0F;
    float gradient_x = 0.0F;
    float gradient_y = 0.0F;
};

/// The homography target <- source of a plane, and its inverse in the form that needs one division per place. All
/// coordinates are relative to the plane's origin and to where that origin lands, so that floats suffice.
class SurfacePatch {
public:
    /// False when the origin lies behind the target eye or the plane is seen edge-on: then nothing may be asked.
    [[nodiscard]] bool set(const PixelMatrix& m, const SourcePlane& plane) {
        plane_ = plane;
        const float x = plane.origin_x_px;
        const float y = plane.origin_y_px;
        const float z = plane.depth;
        w_ = m.one.w + y * m.y.w + x * m.x.w + z * m.z.w;
        if (!(w_ > 0.0F)) return false;
        target_x_px_ = (m.one.x + y * m.y.x + x * m.x.x + z * m.z.x) / w_;
        target_y_px_ = (m.one.y + y * m.y.y + x * m.x.y + z * m.z.y) / w_;
        w_x_ = m.x.w + plane.gradient_x * m.z.w;
        w_y_ = m.y.w + plane.gradient_y * m.z.w;
        const float xx = m.x.x + plane.gradient_x * m.z.x - target_x_px_ * w_x_;
        const float xy = m.y.x + plane.gradient_y * m.z.x - target_x_px_ * w_y_;
        const float yx = m.x.y + plane.gradient_x * m.z.y - target_y_px_ * w_x_;
        const float yy = m.y.y + plane.gradient_y * m.z.y - target_y_px_ * w_y_;
        const float determinant = xx * yy - xy * yx;
        // Below a hundredth of a target pixel per source pixel: edge-on, or seen from its back.
        if (!(determinant > kSmallestArea * w_ * w_)) return false;
        const float scale = 1.0F / determinant;
        inverse_xx_ = yy * scale;
        inverse_xy_ = -xy * scale;
        inverse_yx_ = -yx * scale;
        inverse_yy_ = xx * scale;
        jacobian_ = {xx, xy, yx, yy};
        depth_scale_ = m.depth_scale;
        return true;
    }

    /// Where the source place `origin + (dx, dy)` lands; false behind the eye.
    [[nodiscard]] bool place(float dx, float dy, glm::vec2& target_px) const {
        const float w = w_ + w_x_ * dx + w_y_ * dy;
        if (!(w > 0.0F)) return false;
        target_px = {target_x_px_ + (jacobian_[0] * dx + jacobian_[1] * dy) / w,
                     target_y_px_ + (jacobian_[2] * dx + jacobian_[3] * dy) / w};
        return true;
    }

    struct Solution {
        float dx = 0.0F;  ///< source place relative to the plane's origin
        float dy = 0.0F;
        float depth = 0.0F;  ///< in the target
    };
    /// The source place that lands on a target place, on the plane. False where the plane lies behind the eye.
    [[nodiscard]] bool solve(float target_x_px, float target_y_px, Solution& solution) const {
        const float ex = target_x_px - target_x_px_;
        const float ey = target_y_px - target_y_px_;
        const float kx = inverse_xx_ * ex + inverse_xy_ * ey;
        const float ky = inverse_yx_ * ex + inverse_yy_ * ey;
        const float share = 1.0F - w_x_ * kx - w_y_ * ky;  // w of the origin over w of the place
        if (!(share > 0.0F)) return false;
        const float w = w_ / share;
        solution.dx = w * kx;
        solution.dy = w * ky;
        const float depth = plane_.depth + plane_.gradient_x * solution.dx + plane_.gradient_y * solution.dy;
        solution.depth = depth_scale_ * depth / w;
        return true;
    }

private:
    static constexpr float kSmallestArea = 1e-4F;

    SourcePlane plane_;
    float w_ = 1.0F;
    float target_x_px_ = 0.0F;
    float target_y_px_ = 0.0F;
    float w_x_ = 0.0F;
    float w_y_ = 0.0F;
    float inverse_xx_ = 1.0F;
    float inverse_xy_ = 0.0F;
    float inverse_yx_ = 0.0F;
    float inverse_yy_ = 1.0F;
    glm::vec4 jacobian_{1.0F, 0.0F, 0.0F, 1.0F};
    float depth_scale_ = 1.0F;
};

}  // namespace lw
