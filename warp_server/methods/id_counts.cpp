#include "warp_server/methods/id_counts.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/id_counts.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// How many values from `begin` on equal the first.
std::size_t run_length(const ObjectId* begin, std::size_t count) {
    const hn::ScalableTag<std::uint16_t> d;
    const auto first = hn::Set(d, *begin);
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto other = hn::Ne(hn::LoadU(d, begin + i), first);
        if (!hn::AllFalse(d, other)) return i + static_cast<std::size_t>(hn::FindFirstTrue(d, other));
    }
    while (i < count && begin[i] == *begin) ++i;
    return i;
}

bool all_usable(const float* depths, std::size_t count) {
    const std::size_t lanes = hn::Lanes(DF{});
    auto usable = hn::Eq(hn::Zero(DF{}), hn::Zero(DF{}));
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const VF depth = hn::LoadU(DF{}, depths + i);
        usable = hn::And(usable, hn::And(hn::Ge(depth, hn::Zero(DF{})), hn::Le(depth, hn::Set(DF{}, 1.0F))));
    }
    return hn::AllTrue(DF{}, usable) && std::all_of(depths + i, depths + count, is_usable_depth);
}

void count_row(const ObjectId* ids, const float* depths, std::size_t width, std::vector<IdCount>& by_id) {
    const bool usable = all_usable(depths, width);
    for (std::size_t x = 0; x < width;) {
        const std::size_t end = x + run_length(ids + x, width - x);
        if (ids[x] >= by_id.size()) by_id.resize(std::size_t{ids[x]} + 1);
        IdCount& count = by_id[ids[x]];
        count.pixels += end - x;
        if (!usable) {
            count.bad_depths += static_cast<std::uint64_t>((end - x)) -
                                static_cast<std::uint64_t>(std::count_if(depths + x, depths + end, is_usable_depth));
        }
        x = end;
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(count_row);

std::vector<IdCount> count_ids(const CpuPixels& pixels) {
    std::vector<IdCount> by_id(1);
    const auto width = static_cast<std::size_t>(pixels.depth.width());
    const auto count = HWY_DYNAMIC_DISPATCH(count_row);
    for (int y = 0; y < pixels.depth.height(); ++y) {
        count(pixels.object_id.row(y).data(), pixels.depth.row(y).data(), width, by_id);
    }
    std::vector<IdCount> counts;
    for (std::size_t id = 0; id < by_id.size(); ++id) {
        if (by_id[id].pixels == 0) continue;
        counts.push_back(by_id[id]);
        counts.back().id = static_cast<ObjectId>(id);
    }
    return counts;
}

WarpCounters bad_pixels(std::span<const IdCount> counts, const ObjectMatrices& matrices) {
    WarpCounters counters;
    for (const IdCount& count : counts) {
        if (matrices.find(count.id) == nullptr) {
            counters.unknown_object += count.pixels;
        } else {
            counters.bad_depth += count.bad_depths;
        }
    }
    return counters;
}

}  // namespace lw
#endif
