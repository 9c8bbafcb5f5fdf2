/// The points of `splat`: places, footprints and keys of a vector of pixels. Included by files that Highway compiles
/// for every instruction set.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SPLAT_POINTS_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SPLAT_POINTS_H
#undef LW_WARP_SERVER_METHODS_SPLAT_POINTS_H
#else
#define LW_WARP_SERVER_METHODS_SPLAT_POINTS_H
#endif

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_footprint.h"
#include "warp_server/methods/winner_rule.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Points on their way to the target.
template <class D>
struct PlacedPoints {
    hn::Vec<D> x_px, y_px, depth, inverse_w;
    hn::Mask<D> in_front;  ///< between the eye plane and the near plane there is nothing to see
};

/// Lanes(d) neighbouring pixels of row `y` from column `x` on, all of the object that `m` moves.
template <class D>
HWY_INLINE PlacedPoints<D> place_points(D d, const PixelMatrix& m, int x, int y, hn::Vec<D> depth) {
    const float y_px = static_cast<float>(y) + 0.5F;
    const auto x_px = hn::Add(hn::Iota(d, static_cast<float>(x)), hn::Set(d, 0.5F));
    const auto row_term = [&](float one, float column_y, float column_x, float column_z) {
        const auto start = hn::Set(d, one + y_px * column_y);
        return hn::Add(hn::Add(start, hn::Mul(x_px, hn::Set(d, column_x))), hn::Mul(depth, hn::Set(d, column_z)));
    };
    const auto w = row_term(m.one.w, m.y.w, m.x.w, m.z.w);
    const auto inverse_w = hn::Div(hn::Set(d, 1.0F), w);
    const auto target_depth = hn::Mul(hn::Mul(depth, hn::Set(d, m.depth_scale)), inverse_w);
    return {hn::Mul(row_term(m.one.x, m.y.x, m.x.x, m.z.x), inverse_w),
            hn::Mul(row_term(m.one.y, m.y.y, m.x.y, m.z.y), inverse_w), target_depth, inverse_w,
            hn::And(hn::Gt(w, hn::Zero(d)), hn::Le(target_depth, hn::Set(d, 1.0F)))};
}

/// one_sided_difference of splat_footprint.h.
template <class D>
HWY_INLINE hn::Vec<D> one_sided_differences(D d, hn::Vec<D> depth, hn::Vec<D> before, hn::Vec<D> after) {
    const auto to_before = hn::Sub(depth, before);
    const auto to_after = hn::Sub(after, depth);
    const auto smaller = hn::IfThenElse(hn::Lt(hn::Abs(to_before), hn::Abs(to_after)), to_before, to_after);
    const auto on_surface = hn::Lt(hn::Abs(smaller), hn::Mul(hn::Set(d, kSameSurfaceDepthPart), depth));
    return hn::IfThenElseZero(on_surface, smaller);
}

/// footprint_of in splat_footprint.h.
template <class D>
struct Footprints {
    hn::Vec<D> half_x_px, half_y_px;
};

template <class D>
HWY_INLINE Footprints<D> footprints(D d, const PixelMatrix& m, const PlacedPoints<D>& points, hn::Vec<D> gradient_x,
                                    hn::Vec<D> gradient_y) {
    const auto derivative = [&](float column, float column_w, hn::Vec<D> place) {
        return hn::Mul(hn::Sub(hn::Set(d, column), hn::Mul(place, hn::Set(d, column_w))), points.inverse_w);
    };
    const auto half_extents = [&](hn::Vec<D> along_x, hn::Vec<D> along_y) {
        const auto half = hn::Mul(hn::Set(d, 0.5F), hn::Add(hn::Abs(along_x), hn::Abs(along_y)));
        return hn::Min(hn::Max(half, hn::Set(d, 0.5F)), hn::Set(d, kLargestHalfExtentPx));
    };
    const auto z_x = derivative(m.z.x, m.z.w, points.x_px);
    const auto z_y = derivative(m.z.y, m.z.w, points.y_px);
    return {half_extents(hn::Add(derivative(m.x.x, m.x.w, points.x_px), hn::Mul(gradient_x, z_x)),
                         hn::Add(derivative(m.y.x, m.y.w, points.x_px), hn::Mul(gradient_y, z_x))),
            half_extents(hn::Add(derivative(m.x.y, m.x.w, points.y_px), hn::Mul(gradient_x, z_y)),
                         hn::Add(derivative(m.y.y, m.y.w, points.y_px), hn::Mul(gradient_y, z_y)))};
}

/// winner_key in two halves; the lower half, with the colour, is the same for all pixels that a point covers.
template <class D>
struct KeyParts {
    hn::Vec<hn::RebindToUnsigned<D>> high_but_closeness, low;
};

template <class D>
HWY_INLINE KeyParts<D> key_parts(D /*d*/, hn::Vec<D> depth, hn::Vec<hn::RebindToUnsigned<D>> colours) {
    const hn::RebindToUnsigned<D> du;
    const auto bits = hn::BitCast(du, depth);
    const auto rest = hn::And(bits, hn::Set(du, 0x7FFFU));
    const auto step = hn::ShiftLeft<17>(hn::ShiftRight<15>(bits));
    return {hn::Or(step, hn::ShiftRight<6>(rest)),
            hn::Or(hn::ShiftLeft<26>(rest), hn::And(colours, hn::Set(du, 0xFFFFFFU)))};
}

/// The higher half for pixels whose centres lie (dx, dy) from the points.
template <class D>
HWY_INLINE hn::Vec<hn::RebindToUnsigned<D>> high_of_key(D d, const KeyParts<D>& parts, hn::Vec<D> dx, hn::Vec<D> dy) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const auto distance2 = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const auto farness = hn::Min(hn::Set(d, 254.0F), hn::Mul(distance2, hn::Set(d, 254.0F / kFarthestTold2_px)));
    const auto closeness = hn::Sub(hn::Set(du, 255U), hn::BitCast(du, hn::ConvertTo(di, farness)));
    return hn::Or(parts.high_but_closeness, hn::ShiftLeft<9>(closeness));
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
