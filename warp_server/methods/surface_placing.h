/// Placing pieces of `surface`: where patches land in the target and how to get back, many at once.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_PLACING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_PLACING_H
#undef LW_WARP_SERVER_METHODS_SURFACE_PLACING_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_PLACING_H
#endif

#include <algorithm>
#include <vector>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_classify.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

inline constexpr float kOutOfReachPx = 100000.0F;  // places beyond are in no image
// Target pixels per source pixel, in area, below which a plane counts as seen edge-on; negative: from its back.
inline constexpr float kSmallestArea = 1e-4F;

// `share` of PlacedPatches is 1 where the patch's origin lands and small where the patch is much farther away: 1e-5 of
// the depth were lost at 30.
inline constexpr float kDeepest = 8.0F;

/// Patches laid out for one target, and the way back. With e the offset of a target place from where the patch's origin
/// lands: share = 1 + share_x e_x + share_y e_y, offset in the source = (x_x e_x + x_y e_y, y_x e_x + y_y e_y) / share,
/// and depth in the target = depth + depth_x e_x + depth_y e_y.
struct alignas(HWY_MAX_BYTES) PlacedPatches {
    float target_x[kMaxLanes];
    float target_y[kMaxLanes];
    float x_x[kMaxLanes];
    float x_y[kMaxLanes];
    float y_x[kMaxLanes];
    float y_y[kMaxLanes];
    float share_x[kMaxLanes];
    float share_y[kMaxLanes];
    float depth[kMaxLanes];
    float depth_x[kMaxLanes];
    float depth_y[kMaxLanes];
    std::int32_t x_begin[kMaxLanes];
    std::int32_t x_end[kMaxLanes];
    std::int32_t y_begin[kMaxLanes];
    std::int32_t y_end[kMaxLanes];
};

/// The rows of a picture that are drawn, and its size.
struct TargetBand {
    std::int32_t width_px = 0;
    std::int32_t height_px = 0;
    RowRange rows;

    /// What has no place in the picture is counted by the first band alone.
    [[nodiscard]] bool counts_skips() const { return rows.begin == 0; }
};

/// Patches whose corners all lie beyond one side of the picture, or behind the target eye: cutting them shows nothing.
template <class D>
HWY_INLINE hn::Mask<D> out_of_picture(D d, const PatchList& list, std::size_t first, const PixelMatrix& m,
                                      const TargetBand& band) {
    using V = hn::Vec<D>;
    const auto set = [&](float value) { return hn::Set(d, value); };
    const auto load = [&](const std::vector<float>& values) { return hn::LoadU(d, values.data() + first); };
    const V width = set(static_cast<float>(band.width_px));
    const V height = set(static_cast<float>(band.height_px));
    const auto all = hn::Eq(hn::Zero(d), hn::Zero(d));
    auto left = all;
    auto right = all;
    auto above = all;
    auto below = all;
    auto behind = all;
    for (const auto* dx : {&list.left, &list.right}) {
        for (const auto* dy : {&list.top, &list.bottom}) {
            const V x = hn::Add(hn::Add(load(list.x), set(0.5F)), load(*dx));
            const V y = hn::Add(hn::Add(load(list.y), set(0.5F)), load(*dy));
            const V z = hn::Add(load(list.depth), hn::Add(hn::Mul(load(list.gradient_x), load(*dx)),
                                                          hn::Mul(load(list.gradient_y), load(*dy))));
            const auto row = [&](float one, float of_y, float of_x, float of_z) {
                const V of_place = hn::Add(hn::Mul(y, set(of_y)), hn::Mul(x, set(of_x)));
                return hn::Add(hn::Add(set(one), of_place), hn::Mul(z, set(of_z)));
            };
            const V h_x = row(m.one.x, m.y.x, m.x.x, m.z.x);
            const V h_y = row(m.one.y, m.y.y, m.x.y, m.z.y);
            const V h_w = row(m.one.w, m.y.w, m.x.w, m.z.w);
            left = hn::And(left, hn::Lt(h_x, hn::Zero(d)));
            right = hn::And(right, hn::Gt(h_x, hn::Mul(width, h_w)));
            above = hn::And(above, hn::Lt(h_y, hn::Zero(d)));
            below = hn::And(below, hn::Gt(h_y, hn::Mul(height, h_w)));
            behind = hn::And(behind, hn::Le(h_w, hn::Zero(d)));
        }
    }
    return hn::Or(hn::Or(hn::Or(left, right), hn::Or(above, below)), behind);
}

/// Places Lanes(d) patches of one object from index `first` on. One bit for each of those `wanted` that have pixels in
/// the band. Those that reach behind the target eye have none, nor have those of several cells that are kDeepest times
/// as far from it at one corner as at another; the indices of those that may be seen once they are cut are appended to
/// `behind`. Those that are not in the picture at all are counted.
template <class D, class M>
HWY_INLINE std::uint32_t place_patches(D d, const PatchList& list, std::size_t first, const PixelMatrix& m, M wanted,
                                       const TargetBand& band, PlacedPatches& placed,
                                       std::vector<std::uint32_t>& behind, SurfaceSkips& skips) {
    using V = hn::Vec<D>;
    const hn::RebindToSigned<D> di;
    const auto set = [&](float value) { return hn::Set(d, value); };
    const auto load = [&](const std::vector<float>& values) { return hn::LoadU(d, values.data() + first); };
    const V half_px = set(0.5F);
    const V x = hn::Add(load(list.x), half_px);
    const V y = hn::Add(load(list.y), half_px);
    const V z = load(list.depth);
    const V gradient_x = load(list.gradient_x);
    const V gradient_y = load(list.gradient_y);
    const auto row = [&](float one, float of_y, float of_x, float of_z) {
        return hn::Add(hn::Add(hn::Add(set(one), hn::Mul(y, set(of_y))), hn::Mul(x, set(of_x))), hn::Mul(z, set(of_z)));
    };
    const V w = row(m.one.w, m.y.w, m.x.w, m.z.w);
    const V inverse_w = hn::Div(set(1.0F), w);
    const V target_x = hn::Mul(row(m.one.x, m.y.x, m.x.x, m.z.x), inverse_w);
    const V target_y = hn::Mul(row(m.one.y, m.y.y, m.x.y, m.z.y), inverse_w);
    const auto column = [&](float of_place, V gradient, float of_z) {
        return hn::Add(set(of_place), hn::Mul(gradient, set(of_z)));
    };
    const V w_x = column(m.x.w, gradient_x, m.z.w);
    const V w_y = column(m.y.w, gradient_y, m.z.w);
    const V xx = hn::Sub(column(m.x.x, gradient_x, m.z.x), hn::Mul(target_x, w_x));
    const V xy = hn::Sub(column(m.y.x, gradient_y, m.z.x), hn::Mul(target_x, w_y));
    const V yx = hn::Sub(column(m.x.y, gradient_x, m.z.y), hn::Mul(target_y, w_x));
    const V yy = hn::Sub(column(m.y.y, gradient_y, m.z.y), hn::Mul(target_y, w_y));
    const V determinant = hn::Sub(hn::Mul(xx, yy), hn::Mul(xy, yx));

    // The box around the projected corners.
    V low_x = set(kOutOfReachPx);
    V low_y = low_x;
    V high_x = set(-kOutOfReachPx);
    V high_y = high_x;
    auto in_front = hn::Gt(w, hn::Zero(d));
    V nearest_w = w;
    V farthest_w = w;
    for (const auto* dx : {&list.left, &list.right}) {
        for (const auto* dy : {&list.top, &list.bottom}) {
            const V corner_x = load(*dx);
            const V corner_y = load(*dy);
            const V corner_w = hn::Add(hn::Add(w, hn::Mul(w_x, corner_x)), hn::Mul(w_y, corner_y));
            in_front = hn::And(in_front, hn::Gt(corner_w, hn::Zero(d)));
            nearest_w = hn::Min(nearest_w, corner_w);
            farthest_w = hn::Max(farthest_w, corner_w);
            const V scale = hn::Div(set(1.0F), corner_w);
            const V place_x = hn::Add(target_x, hn::Mul(hn::Add(hn::Mul(xx, corner_x), hn::Mul(xy, corner_y)), scale));
            const V place_y = hn::Add(target_y, hn::Mul(hn::Add(hn::Mul(yx, corner_x), hn::Mul(yy, corner_y)), scale));
            low_x = hn::Min(low_x, place_x);
            low_y = hn::Min(low_y, place_y);
            high_x = hn::Max(high_x, place_x);
            high_y = hn::Max(high_y, place_y);
        }
    }
    const V one_cell = set(1.5F);
    const auto is_large = hn::Or(hn::Gt(load(list.right), one_cell), hn::Gt(load(list.bottom), one_cell));
    const auto is_deep = hn::And(is_large, hn::Gt(farthest_w, hn::Mul(nearest_w, set(kDeepest))));
    in_front = hn::AndNot(is_deep, in_front);
    std::uint32_t to_cut = bits_of(d, hn::AndNot(in_front, wanted));
    if (to_cut != 0) {
        const std::uint32_t unseen = to_cut & bits_of(d, out_of_picture(d, list, first, m, band));
        if (band.counts_skips()) skips.outside += static_cast<std::uint64_t>(__builtin_popcount(unseen));
        to_cut &= ~unseen;
    }
    for (std::uint32_t bits = to_cut; bits != 0; bits &= bits - 1) {
        behind.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(__builtin_ctz(bits))));
    }
    const auto bounded = [&](V value, float low, float high) {
        return truncated(hn::Min(hn::Max(value, set(low)), set(high)));
    };
    const auto width = static_cast<float>(band.width_px);
    const auto band_begin = static_cast<float>(band.rows.begin);
    const auto band_end = static_cast<float>(band.rows.end);
    const auto x_begin = bounded(hn::Ceil(hn::Sub(low_x, half_px)), 0.0F, width);
    const auto x_end = bounded(hn::Floor(hn::Add(high_x, half_px)), 0.0F, width);
    const auto y_begin = bounded(hn::Ceil(hn::Sub(low_y, half_px)), band_begin, band_end);
    const auto y_end = bounded(hn::Floor(hn::Add(high_y, half_px)), band_begin, band_end);
    const auto not_empty = hn::And(hn::Lt(x_begin, x_end), hn::Lt(y_begin, y_end));
    const auto faces_us = hn::Gt(determinant, hn::Mul(set(kSmallestArea), hn::Mul(w, w)));
    const auto in_reach =
        hn::And(hn::Lt(hn::Abs(target_x), set(kOutOfReachPx)), hn::Lt(hn::Abs(target_y), set(kOutOfReachPx)));
    const auto visible =
        hn::And(hn::And(wanted, hn::And(in_front, in_reach)), hn::And(faces_us, hn::RebindMask(d, not_empty)));
    if (band.counts_skips()) {
        const auto in_picture =
            hn::And(hn::And(hn::Ge(high_x, half_px), hn::Le(low_x, set(width - 0.5F))),
                    hn::And(hn::Ge(high_y, half_px), hn::Le(low_y, set(static_cast<float>(band.height_px) - 0.5F))));
        const auto placed_ones = hn::And(wanted, in_front);
        skips.empty += hn::CountTrue(d, hn::AndNot(faces_us, placed_ones));
        skips.outside += hn::CountTrue(d, hn::AndNot(in_picture, hn::And(placed_ones, faces_us)));
    }
    const std::uint32_t bits = bits_of(d, visible);
    if (bits == 0) return 0;

    // k = inverse * e, share = 1 - w_x kx - w_y ky, offset in the source = w / share * k.
    const V scale = hn::Div(set(1.0F), determinant);
    const V k_xx = hn::Mul(yy, scale);
    const V k_xy = hn::Neg(hn::Mul(xy, scale));
    const V k_yx = hn::Neg(hn::Mul(yx, scale));
    const V k_yy = hn::Mul(xx, scale);
    const V share_x = hn::Neg(hn::Add(hn::Mul(w_x, k_xx), hn::Mul(w_y, k_yx)));
    const V share_y = hn::Neg(hn::Add(hn::Mul(w_x, k_xy), hn::Mul(w_y, k_yy)));
    const V x_x = hn::Mul(w, k_xx);
    const V x_y = hn::Mul(w, k_xy);
    const V y_x = hn::Mul(w, k_yx);
    const V y_y = hn::Mul(w, k_yy);
    // Depth in the target = factor * share * depth in the source, and that is affine where the pixel is.
    const V factor = hn::Mul(set(m.depth_scale), inverse_w);
    const auto depth_step = [&](V share_step, V x_step, V y_step) {
        const V along = hn::Add(hn::Mul(gradient_x, x_step), hn::Mul(gradient_y, y_step));
        return hn::Mul(factor, hn::Add(hn::Mul(z, share_step), along));
    };
    hn::Store(target_x, d, placed.target_x);
    hn::Store(target_y, d, placed.target_y);
    hn::Store(x_x, d, placed.x_x);
    hn::Store(x_y, d, placed.x_y);
    hn::Store(y_x, d, placed.y_x);
    hn::Store(y_y, d, placed.y_y);
    hn::Store(share_x, d, placed.share_x);
    hn::Store(share_y, d, placed.share_y);
    hn::Store(hn::Mul(factor, z), d, placed.depth);
    hn::Store(depth_step(share_x, x_x, y_x), d, placed.depth_x);
    hn::Store(depth_step(share_y, x_y, y_y), d, placed.depth_y);
    hn::Store(x_begin, di, placed.x_begin);
    hn::Store(x_end, di, placed.x_end);
    hn::Store(y_begin, di, placed.y_begin);
    hn::Store(y_end, di, placed.y_end);
    return bits;
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
