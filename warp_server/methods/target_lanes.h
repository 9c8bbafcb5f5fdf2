/// Writing a vector of target pixels. Included by files that Highway compiles for every instruction set.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_TARGET_LANES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_TARGET_LANES_H
#undef LW_WARP_SERVER_METHODS_TARGET_LANES_H
#else
#define LW_WARP_SERVER_METHODS_TARGET_LANES_H
#endif

#include <algorithm>

#include "warp_server/methods/lanes.h"
#include "warp_server/warp_method.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Lanes(DF) pixels of row y from column x on, some of them perhaps beyond the row. Those that were not `reached`
/// become holes.
HWY_INLINE void write_target(int x, int y, hn::Mask<DF> reached, hn::VFromD<DU> colour, VF depth, DisplayFrame& out) {
    colour = hn::IfThenElseZero(hn::RebindMask(DU{}, reached), colour);
    depth = hn::IfThenElseZero(reached, depth);
    const auto coverage = hn::IfThenElseZero(hn::RebindMask(DI{}, reached), hn::Set(DI{}, 1));
    const hn::Rebind<std::uint8_t, DF> d8;
    const std::size_t lanes = hn::Lanes(DF{});
    const std::size_t index =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(out.depth.width()) + static_cast<std::size_t>(x);
    auto* colours = reinterpret_cast<std::uint32_t*>(out.colour.pixels().data()) + index;
    auto* coverages = reinterpret_cast<std::uint8_t*>(out.coverage.pixels().data()) + index;
    float* depths = out.depth.pixels().data() + index;
    const std::size_t count = std::min(lanes, static_cast<std::size_t>(out.depth.width() - x));
    if (count == lanes) {
        hn::StoreU(colour, DU{}, colours);
        hn::StoreU(depth, DF{}, depths);
        hn::StoreU(hn::DemoteTo(d8, coverage), d8, coverages);
        return;
    }
    HWY_ALIGN std::uint32_t colour_lanes[kMaxLanes];
    HWY_ALIGN float depth_lanes[kMaxLanes];
    HWY_ALIGN std::uint8_t coverage_lanes[kMaxLanes];
    hn::Store(colour, DU{}, colour_lanes);
    hn::Store(depth, DF{}, depth_lanes);
    hn::StoreU(hn::DemoteTo(d8, coverage), d8, coverage_lanes);
    std::copy_n(colour_lanes, count, colours);
    std::copy_n(depth_lanes, count, depths);
    std::copy_n(coverage_lanes, count, coverages);
}

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
