// Compiled once per instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/held_depths.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include <hwy/highway.h>

#include "warp_server/held_depths.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::ScalableTag<float>;

void hold_depths_here(float* depths, std::size_t count, float farthest) {
    const DF d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto depth = hn::LoadU(d, depths + i);
        const auto is_farther = hn::Lt(depth, hn::Set(d, farthest));
        hn::StoreU(hn::IfThenElse(is_farther, depth, hn::Set(d, kHeldDepth)), d, depths + i);
    }
    for (; i < count; ++i) depths[i] = depths[i] < farthest ? depths[i] : kHeldDepth;
}

void release_depths_here(float* depths, const float* before, std::size_t count) {
    const DF d;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto depth = hn::LoadU(d, depths + i);
        const auto is_held = hn::Gt(depth, hn::Set(d, 1.0F));
        hn::StoreU(hn::IfThenElse(is_held, hn::LoadU(d, before + i), depth), d, depths + i);
    }
    for (; i < count; ++i) depths[i] = depths[i] > 1.0F ? before[i] : depths[i];
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(hold_depths_here);
HWY_EXPORT(release_depths_here);

void hold_depths(float* depths, std::size_t count, float farthest) {
    HWY_DYNAMIC_DISPATCH(hold_depths_here)(depths, count, farthest);
}

void release_depths(float* depths, const float* before, std::size_t count) {
    HWY_DYNAMIC_DISPATCH(release_depths_here)(depths, before, count);
}

}  // namespace lw
#endif
