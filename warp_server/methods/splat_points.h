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

/// `m` in all lanes, for row `y`.
template <class D>
HWY_INLINE LaneMatrices<D> same_matrices(D d, const PixelMatrix& m, int y) {
    const auto column = [&](const PixelMatrix::Column& own) {
        return typename LaneMatrices<D>::Column{hn::Set(d, own.x), hn::Set(d, own.y), hn::Set(d, own.w)};
    };
    const float y_px = static_cast<float>(y) + 0.5F;
    const PixelMatrix::Column start{m.one.x + y_px * m.y.x, m.one.y + y_px * m.y.y, m.one.w + y_px * m.y.w};
    return {column(start), column(m.x), column(m.y), column(m.z), hn::Set(d, m.depth_scale)};
}

/// Points on their way to the target.
template <class D>
struct PlacedPoints {
    hn::Vec<D> x_px, y_px, depth, inverse_w;
    hn::Vec<D> w_x_px, w_y_px, w;  ///< the same before the division
    hn::Mask<D> in_front;          ///< between the eye plane and the near plane there is nothing to see
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
    const auto w_x_px = row_term(m.start.x, m.x.x, m.z.x);
    const auto w_y_px = row_term(m.start.y, m.x.y, m.z.y);
    return {hn::Mul(w_x_px, inverse_w),
            hn::Mul(w_y_px, inverse_w),
            target_depth,
            inverse_w,
            w_x_px,
            w_y_px,
            w,
            hn::And(hn::Gt(w, hn::Zero(d)), hn::Le(target_depth, hn::Set(d, 1.0F)))};
}

/// footprint_of in splat_footprint.h.
template <class D>
struct Footprints {
    hn::Vec<D> half_x_px, half_y_px;
};

template <class D>
HWY_INLINE Footprints<D> footprints(D d, const LaneMatrices<D>& m, const PlacedPoints<D>& points, hn::Vec<D> gradient_x,
                                    hn::Vec<D> gradient_y) {
    // Of w * place and of w, along the source's columns and rows.
    const auto along = [&](hn::Vec<D> column, hn::Vec<D> gradient, hn::Vec<D> column_z) {
        return hn::Add(column, hn::Mul(gradient, column_z));
    };
    const auto w_x = along(m.x.w, gradient_x, m.z.w);
    const auto w_y = along(m.y.w, gradient_y, m.z.w);
    // w squared times the derivatives of a place: they are ready before the division is.
    const auto derivative = [&](hn::Vec<D> of_w_place, hn::Vec<D> w_place, hn::Vec<D> of_w) {
        return hn::Abs(hn::Sub(hn::Mul(of_w_place, points.w), hn::Mul(w_place, of_w)));
    };
    const auto half_per_w2 = hn::Mul(hn::Mul(hn::Set(d, 0.5F), points.inverse_w), points.inverse_w);
    const auto half_extents = [&](hn::Vec<D> along_x, hn::Vec<D> along_y, hn::Vec<D> w_place) {
        const auto sum = hn::Add(derivative(along_x, w_place, w_x), derivative(along_y, w_place, w_y));
        return hn::Min(hn::Max(hn::Mul(half_per_w2, sum), hn::Set(d, 0.5F)), hn::Set(d, kLargestHalfExtentPx));
    };
    return {half_extents(along(m.x.x, gradient_x, m.z.x), along(m.y.x, gradient_y, m.z.x), points.w_x_px),
            half_extents(along(m.x.y, gradient_x, m.z.y), along(m.y.y, gradient_y, m.z.y), points.w_y_px)};
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
