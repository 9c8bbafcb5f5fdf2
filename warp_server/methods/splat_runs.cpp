#include "warp_server/methods/splat_runs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/splat_runs.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/splat_footprint.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

constexpr float kNoNeighbour = 8.0F;  // a depth that lies on no surface: depths are at most 1

template <class D>
hn::VFromD<hn::RebindToUnsigned<D>> load_ids(D /*d*/, const ObjectId* ids) {
    return hn::PromoteTo(hn::RebindToUnsigned<D>{}, hn::LoadU(hn::Rebind<std::uint16_t, D>{}, ids));
}

template <class D>
hn::Mask<D> usable(D d, hn::Vec<D> depth) {
    return hn::And(hn::Ge(depth, hn::Zero(d)), hn::Le(depth, hn::Set(d, 1.0F)));
}

// Depths of the neighbours `offset` pixels away, kNoNeighbour where they are of another object or unusable.
template <class D, class Ids>
hn::Vec<D> neighbour_depths(D d, const float* depths, const ObjectId* ids, std::ptrdiff_t offset, Ids own_ids) {
    const auto depth = hn::LoadU(d, depths + offset);
    const auto same_object = hn::RebindMask(d, hn::Eq(load_ids(d, ids + offset), own_ids));
    return hn::IfThenElse(hn::And(same_object, usable(d, depth)), depth, hn::Set(d, kNoNeighbour));
}

// Which neighbour one_sided_difference takes.
template <class D>
struct Slope {
    hn::Mask<D> after, before;
};

template <class D>
Slope<D> slope(D d, hn::Vec<D> depth, hn::Vec<D> before, hn::Vec<D> after) {
    const auto to_before = hn::Abs(hn::Sub(depth, before));
    const auto to_after = hn::Abs(hn::Sub(after, depth));
    const auto margin = hn::Mul(hn::Set(d, kClearlySmallerDepthPart), depth);
    const auto before_is_smaller = hn::Lt(hn::Add(to_before, margin), to_after);
    const auto on_surface = hn::Mul(hn::Set(d, kSameSurfaceDepthPart), depth);
    return {hn::AndNot(before_is_smaller, hn::Lt(to_after, on_surface)),
            hn::And(before_is_smaller, hn::Lt(to_before, on_surface))};
}

// One bit per pixel of a block, of whatever objects.
struct BlockMasks {
    std::uint32_t background = 0;
    std::uint32_t unusable = 0;
    std::uint32_t points = 0;
    std::uint32_t after_x = 0;
    std::uint32_t before_x = 0;
    std::uint32_t after_y = 0;
    std::uint32_t before_y = 0;
};

// Looks at Lanes(d) pixels from column `x` on, which are bit `first` and those after it.
template <class D>
HWY_INLINE void look_at(D d, const CpuPixels& pixels, int x, int y, int first, BlockMasks& masks) {
    const hn::RebindToUnsigned<D> du;
    const int width = pixels.depth.width();
    const float* depths = pixels.depth.row(y).data() + x;
    const ObjectId* id_row = pixels.object_id.row(y).data() + x;
    const auto depth = hn::LoadU(d, depths);
    const auto ids = load_ids(d, id_row);
    const auto background = hn::And(hn::Eq(depth, hn::Zero(d)), hn::RebindMask(d, hn::Eq(ids, hn::Zero(du))));
    const auto is_usable = usable(d, depth);
    const auto points = hn::AndNot(background, is_usable);
    masks.background |= bits_of(d, background) << first;
    masks.unusable |= bits_of(d, hn::Not(is_usable)) << first;
    if (hn::AllFalse(d, points)) return;

    // Reading one pixel beyond a row's end meets the next row, which the masks below undo; only the very first and last
    // pixel of the image have no memory beside them, and the caller hands those over one lane at a time.
    const auto none = hn::Set(d, kNoNeighbour);
    const bool at_left = x == 0;
    const bool at_right = x + static_cast<int>(hn::Lanes(d)) == width;
    const bool alone = hn::Lanes(d) == 1;
    auto left = none;
    auto right = none;
    if (!(at_left && alone)) left = neighbour_depths(d, depths, id_row, -1, ids);
    if (!(at_right && alone)) right = neighbour_depths(d, depths, id_row, 1, ids);
    if (at_left) left = hn::IfThenElse(hn::FirstN(d, 1), none, left);
    if (at_right) right = hn::IfThenElse(hn::FirstN(d, hn::Lanes(d) - 1), right, none);
    const auto above = y == 0 ? none : neighbour_depths(d, depths, id_row, -std::ptrdiff_t{width}, ids);
    const auto below =
        y + 1 == pixels.depth.height() ? none : neighbour_depths(d, depths, id_row, std::ptrdiff_t{width}, ids);
    const Slope<D> x_slope = slope(d, depth, left, right);
    const Slope<D> y_slope = slope(d, depth, above, below);
    masks.points |= bits_of(d, points) << first;
    masks.after_x |= bits_of(d, x_slope.after) << first;
    masks.before_x |= bits_of(d, x_slope.before) << first;
    masks.after_y |= bits_of(d, y_slope.after) << first;
    masks.before_y |= bits_of(d, y_slope.before) << first;
}

BlockMasks masks_of(const CpuPixels& pixels, int x, int y) {
    const hn::CappedTag<float, kBlockWidth_px> d;
    const hn::CappedTag<float, 1> d1;
    const int lanes = static_cast<int>(hn::Lanes(d));
    const glm::ivec2 size_px = pixels.depth.size_px();
    const int count = std::min(kBlockWidth_px, size_px.x - x);
    const bool beside_nothing = (y == 0 && x == 0) || (y + 1 == size_px.y && x + count == size_px.x);
    BlockMasks masks;
    if (count == kBlockWidth_px && !beside_nothing) {
        for (int i = 0; i < count; i += lanes) look_at(d, pixels, x + i, y, i, masks);
    } else {
        for (int i = 0; i < count; ++i) look_at(d1, pixels, x + i, y, i, masks);
    }
    return masks;
}

// The pixels of `points` that are of `object`.
std::uint32_t pixels_of(const ObjectId* ids, ObjectId object, std::uint32_t points) {
    std::uint32_t same = 0;
    for (; points != 0; points &= points - 1) {
        const int i = std::countr_zero(points);
        if (ids[i] == object) same |= 1U << static_cast<unsigned>(i);
    }
    return same;
}

// Of the pixels `own` of a block; `is_whole`: all 16 are there.
ObjectDepths depths_of(const float* depths, ObjectId object, std::uint32_t own, bool is_whole) {
    const hn::CappedTag<float, kBlockWidth_px> d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    ObjectDepths found{object};
    if (!is_whole) {
        for (; own != 0; own &= own - 1) {
            const float depth = depths[std::countr_zero(own)];
            found = {object, std::min(found.least, depth), std::max(found.greatest, depth)};
        }
        return found;
    }
    auto least = hn::Set(d, found.least);
    auto greatest = hn::Set(d, found.greatest);
    for (int i = 0; i < kBlockWidth_px; i += lanes) {
        const auto mine = lanes_of_bits(d, own >> static_cast<unsigned>(i) & ((1U << hn::Lanes(d)) - 1U));
        const auto depth = hn::LoadU(d, depths + i);
        least = hn::IfThenElse(mine, hn::Min(least, depth), least);
        greatest = hn::IfThenElse(mine, hn::Max(greatest, depth), greatest);
    }
    return {object, hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, greatest))};
}

void add(std::vector<ObjectDepths>& objects, const ObjectDepths& depths) {
    // Most often the one that was met last.
    const auto known = std::find_if(objects.rbegin(), objects.rend(),
                                    [&](const ObjectDepths& other) { return other.object == depths.object; });
    if (known == objects.rend()) {
        objects.push_back(depths);
        return;
    }
    known->least = std::min(known->least, depths.least);
    known->greatest = std::max(known->greatest, depths.greatest);
}

void find_in_block(const CpuPixels& pixels, int x, int y, TilePixels& found) {
    const BlockMasks masks = masks_of(pixels, x, y);
    const float* depths = pixels.depth.row(y).data() + x;
    const ObjectId* ids = pixels.object_id.row(y).data() + x;
    const bool is_whole = x + kBlockWidth_px <= pixels.depth.width();
    found.rests.push_back({static_cast<std::uint16_t>(masks.background), static_cast<std::uint16_t>(masks.unusable)});
    for (std::uint32_t remaining = masks.points; remaining != 0;) {
        const ObjectId object = ids[std::countr_zero(remaining)];
        const std::uint32_t own = pixels_of(ids, object, remaining);
        remaining &= ~own;
        const auto of_own = [&](std::uint32_t mask) { return static_cast<std::uint16_t>(mask & own); };
        const SplatRun run{static_cast<std::uint16_t>(x),
                           static_cast<std::uint16_t>(y),
                           object,
                           of_own(own),
                           of_own(masks.after_x),
                           of_own(masks.before_x),
                           of_own(masks.after_y),
                           of_own(masks.before_y)};
        (run.is_smooth() ? found.smooth : found.others).push_back(run);
        add(found.objects, depths_of(depths, object, own, is_whole));
    }
}

void find_runs_here(const CpuPixels& pixels, const PixelRect& tile, TilePixels& found) {
    found.smooth.clear();
    found.others.clear();
    found.objects.clear();
    found.rests.clear();
    for (int x = tile.first_px.x; x < tile.end_px.x; x += kBlockWidth_px) {
        for (int y = tile.first_px.y; y < tile.end_px.y; ++y) find_in_block(pixels, x, y, found);
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(find_runs_here);

void find_runs(const CpuPixels& pixels, const PixelRect& tile, TilePixels& found) {
    HWY_DYNAMIC_DISPATCH(find_runs_here)(pixels, tile, found);
}

}  // namespace lw
#endif
