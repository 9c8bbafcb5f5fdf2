/// Where on a piece of `surface` a target pixel lies.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#undef LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#endif

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Target pixels laid back onto a patch.
struct Solved {
    VF dx;  ///< place in the source relative to the patch's origin
    VF dy;
    VF depth;  ///< in the target
};

/// A patch and its homography, or one of each per lane.
struct Patch {
    VF target_x, target_y, w, w_x, w_y, inverse_xx, inverse_xy, inverse_yx, inverse_yy, depth_factor;
    VF depth, gradient_x, gradient_y, left, right, top, bottom;
};

/// Lays target pixels back onto the patch; true where they are inside of it.
HWY_INLINE hn::Mask<DF> solve(const Patch& patch, VF pixel_x, VF pixel_y, Solved& solved) {
    const VF half_px = hn::Set(DF{}, 0.5F);
    const VF one = hn::Set(DF{}, 1.0F);
    const VF ex = hn::Sub(hn::Add(pixel_x, half_px), patch.target_x);
    const VF ey = hn::Sub(hn::Add(pixel_y, half_px), patch.target_y);
    const VF kx = hn::Add(hn::Mul(patch.inverse_xx, ex), hn::Mul(patch.inverse_xy, ey));
    const VF ky = hn::Add(hn::Mul(patch.inverse_yx, ex), hn::Mul(patch.inverse_yy, ey));
    const VF share = hn::Sub(hn::Sub(one, hn::Mul(patch.w_x, kx)), hn::Mul(patch.w_y, ky));
    const VF place_w = hn::Div(patch.w, share);
    solved.dx = hn::Mul(place_w, kx);
    solved.dy = hn::Mul(place_w, ky);
    const VF source_depth =
        hn::Add(hn::Add(patch.depth, hn::Mul(patch.gradient_x, solved.dx)), hn::Mul(patch.gradient_y, solved.dy));
    solved.depth = hn::Max(hn::Mul(hn::Mul(patch.depth_factor, share), source_depth), hn::Zero(DF{}));
    const auto in_columns = hn::And(hn::Ge(solved.dx, patch.left), hn::Le(solved.dx, patch.right));
    const auto in_rows = hn::And(hn::Ge(solved.dy, patch.top), hn::Le(solved.dy, patch.bottom));
    const auto in_front = hn::And(hn::Gt(share, hn::Zero(DF{})), hn::Le(solved.depth, one));
    return hn::And(hn::And(in_columns, in_rows), in_front);
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
