/// Where on a piece of `surface` a target pixel lies.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#undef LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_SOLVING_H
#endif

#include <algorithm>
#include <cmath>
#include <vector>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_placing.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// A patch and its way back from the target (PlacedPatches), or one of each per lane.
struct Patch {
    VF target_x, target_y;
    VF x_x, x_y, y_x, y_y, share_x, share_y;
    VF depth, depth_x, depth_y;
    VF left, right, top, bottom;
};

/// Lane `lane` of the placed patches in every lane; it is patch `index` of the list.
[[nodiscard]] HWY_INLINE Patch one_patch(const PlacedPatches& placed, std::size_t lane, const PatchList& list,
                                         std::size_t index) {
    const auto set = [](float value) { return hn::Set(DF{}, value); };
    return {set(placed.target_x[lane]), set(placed.target_y[lane]), set(placed.x_x[lane]),
            set(placed.x_y[lane]),      set(placed.y_x[lane]),      set(placed.y_y[lane]),
            set(placed.share_x[lane]),  set(placed.share_y[lane]),  set(placed.depth[lane]),
            set(placed.depth_x[lane]),  set(placed.depth_y[lane]),  set(list.left[index]),
            set(list.right[index]),     set(list.top[index]),       set(list.bottom[index])};
}

/// A patch per lane: those from index `first` of the list on.
[[nodiscard]] HWY_INLINE Patch many_patches(const PlacedPatches& placed, const PatchList& list, std::size_t first) {
    const auto load = [](const float* values) { return hn::Load(DF{}, values); };
    const auto loaded = [&](const std::vector<float>& values) { return hn::LoadU(DF{}, values.data() + first); };
    return {load(placed.target_x), load(placed.target_y), load(placed.x_x),     load(placed.x_y),
            load(placed.y_x),      load(placed.y_y),      load(placed.share_x), load(placed.share_y),
            load(placed.depth),    load(placed.depth_x),  load(placed.depth_y), loaded(list.left),
            loaded(list.right),    loaded(list.top),      loaded(list.bottom)};
}

/// What is the same for all pixels of a target row.
struct PatchRow {
    VF x, y, share, depth;
};

/// @param pixel_y  whole numbers
[[nodiscard]] HWY_INLINE PatchRow row_of(const Patch& patch, VF pixel_y) {
    const VF ey = hn::Sub(hn::Add(pixel_y, hn::Set(DF{}, 0.5F)), patch.target_y);
    return {hn::Mul(patch.x_y, ey), hn::Mul(patch.y_y, ey), hn::Add(hn::Set(DF{}, 1.0F), hn::Mul(patch.share_y, ey)),
            hn::Add(patch.depth, hn::Mul(patch.depth_y, ey))};
}

/// Columns [begin, end) of one row.
struct RowSpan {
    int begin = 0;
    int end = 0;
};

/// The part of `box` in which pixels of the row may be inside of the patch, which is one in all lanes: a few too many,
/// none too few.
[[nodiscard]] inline RowSpan span_of(const Patch& patch, const PatchRow& row, RowSpan box) {
    const auto value = [](VF of_all) { return hn::GetLane(of_all); };
    // left * share <= offset <= right * share, and so in y: four bounds that are linear in e_x.
    float low = static_cast<float>(box.begin);
    float high = static_cast<float>(box.end);
    const float origin = value(patch.target_x) - 0.5F;
    const auto cut = [&](float slope, float constant) {  // slope * e_x + constant >= 0
        if (std::abs(slope) < 1e-6F) return;
        const float at = origin - constant / slope;
        if (slope > 0.0F) {
            low = std::max(low, at - 1.0F);
        } else {
            high = std::min(high, at + 2.0F);
        }
    };
    const auto between = [&](VF step, VF start, VF least, VF most) {
        cut(value(step) - value(least) * value(patch.share_x), value(start) - value(least) * value(row.share));
        cut(value(most) * value(patch.share_x) - value(step), value(most) * value(row.share) - value(start));
    };
    between(patch.x_x, row.x, patch.left, patch.right);
    between(patch.y_x, row.y, patch.top, patch.bottom);
    if (!(low < high)) return {box.begin, box.begin};
    return {static_cast<int>(low), std::min(box.end, static_cast<int>(high) + 1)};
}

/// Target pixels laid back onto a patch.
struct Solved {
    VF dx;  ///< place in the source relative to the patch's origin
    VF dy;
    VF depth;  ///< in the target
};

/// Lays target pixels of a row back onto the patch; true where they are inside of it. The same whether a vector holds
/// pixels of one patch or one pixel each of many.
[[nodiscard]] HWY_INLINE hn::Mask<DF> solve(const Patch& patch, const PatchRow& row, VF pixel_x, Solved& solved) {
    const VF ex = hn::Sub(hn::Add(pixel_x, hn::Set(DF{}, 0.5F)), patch.target_x);
    const VF share = hn::Add(hn::Mul(patch.share_x, ex), row.share);
    const VF scale = hn::Div(hn::Set(DF{}, 1.0F), share);
    solved.dx = hn::Mul(hn::Add(hn::Mul(patch.x_x, ex), row.x), scale);
    solved.dy = hn::Mul(hn::Add(hn::Mul(patch.y_x, ex), row.y), scale);
    solved.depth = hn::Max(hn::Add(hn::Mul(patch.depth_x, ex), row.depth), hn::Zero(DF{}));
    // Places behind the eye need no test: each source place has one target place, and those of the patch lie in front.
    const auto in_columns = hn::And(hn::Ge(solved.dx, patch.left), hn::Le(solved.dx, patch.right));
    const auto in_rows = hn::And(hn::Ge(solved.dy, patch.top), hn::Le(solved.dy, patch.bottom));
    const auto beyond_near_plane = hn::Le(solved.depth, hn::Set(DF{}, 1.0F));
    return hn::And(hn::And(in_columns, in_rows), beyond_near_plane);
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
