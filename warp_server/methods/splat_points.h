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

/// The PixelMatrix of every lane, for pixels of one row.
template <class D>
struct LaneMatrices {
    struct Column {
        hn::Vec<D> x, y, w;
    };
    Column start;  ///< of the row: one + y * y_px
    Column x, y, z;
    hn::Vec<D> depth_scale;
};

/// What `lane_of` makes of every value of `m` for row `y`; it is given the value and the one of `before`.
template <class D, class LaneOf>
HWY_INLINE LaneMatrices<D> matrices_of(const PixelMatrix& m, int y, const LaneMatrices<D>& before,
                                       const LaneOf& lane_of) {
    const auto column = [&](const PixelMatrix::Column& own, const typename LaneMatrices<D>::Column& old) {
        return typename LaneMatrices<D>::Column{lane_of(own.x, old.x), lane_of(own.y, old.y), lane_of(own.w, old.w)};
    };
    const float y_px = static_cast<float>(y) + 0.5F;
    const PixelMatrix::Column start{m.one.x + y_px * m.y.x, m.one.y + y_px * m.y.y, m.one.w + y_px * m.y.w};
    return {column(start, before.start), column(m.x, before.x), column(m.y, before.y), column(m.z, before.z),
            lane_of(m.depth_scale, before.depth_scale)};
}

/// `m` in all lanes.
template <class D>
HWY_INLINE LaneMatrices<D> same_matrices(D d, const PixelMatrix& m, int y) {
    return matrices_of(m, y, LaneMatrices<D>{}, [&](float value, hn::Vec<D> /*old*/) { return hn::Set(d, value); });
}

/// `m` in the `lanes`, `before` in the others.
template <class D>
HWY_INLINE LaneMatrices<D> with_matrix(D d, const LaneMatrices<D>& before, hn::Mask<D> lanes, const PixelMatrix& m,
                                       int y) {
    return matrices_of(m, y, before,
                       [&](float value, hn::Vec<D> old) { return hn::IfThenElse(lanes, hn::Set(d, value), old); });
}

/// Points on their way to the target.
template <class D>
struct PlacedPoints {
    hn::Vec<D> x_px, y_px, depth, inverse_w;
    hn::Mask<D> in_front;  ///< between the eye plane and the near plane there is nothing to see
};

/// Lanes(d) neighbouring pixels of the matrices' row from column `x` on.
template <class D>
HWY_INLINE PlacedPoints<D> place_points(D d, const LaneMatrices<D>& m, int x, hn::Vec<D> depth) {
    const auto x_px = hn::Add(lanes_from(d, static_cast<float>(x)), hn::Set(d, 0.5F));
    const auto row_term = [&](hn::Vec<D> start, hn::Vec<D> column_x, hn::Vec<D> column_z) {
        return hn::Add(hn::Add(start, hn::Mul(x_px, column_x)), hn::Mul(depth, column_z));
    };
    const auto w = row_term(m.start.w, m.x.w, m.z.w);
    const auto inverse_w = hn::Div(hn::Set(d, 1.0F), w);
    const auto target_depth = hn::Mul(hn::Mul(depth, m.depth_scale), inverse_w);
    return {hn::Mul(row_term(m.start.x, m.x.x, m.z.x), inverse_w),
            hn::Mul(row_term(m.start.y, m.x.y, m.z.y), inverse_w), target_depth, inverse_w,
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
HWY_INLINE Footprints<D> footprints(D d, const LaneMatrices<D>& m, const PlacedPoints<D>& points, hn::Vec<D> gradient_x,
                                    hn::Vec<D> gradient_y) {
    // w times the derivatives of a place by the source's columns, rows and depth.
    const auto derivative = [&](hn::Vec<D> column, hn::Vec<D> column_w, hn::Vec<D> place) {
        return hn::Sub(column, hn::Mul(place, column_w));
    };
    const auto half_per_w = hn::Mul(hn::Set(d, 0.5F), points.inverse_w);
    const auto half_extents = [&](hn::Vec<D> along_x, hn::Vec<D> along_y) {
        const auto half = hn::Mul(half_per_w, hn::Add(hn::Abs(along_x), hn::Abs(along_y)));
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
    const auto distance2 = hn::Add(hn::Mul(dx, dx), hn::Mul(dy, dy));
    const auto falling = hn::Sub(hn::Set(d, kClosestMantissa), hn::Mul(distance2, hn::Set(d, kMantissaPerPx2)));
    const auto bits = hn::BitCast(du, hn::Max(falling, hn::Set(d, kFarthestMantissa)));
    constexpr int kShift = kMantissaShift - 9;
    return hn::Or(parts.high_but_closeness, hn::And(hn::ShiftRight<kShift>(bits), hn::Set(du, 0xFFU << 9U)));
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
