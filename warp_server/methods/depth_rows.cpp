#include "warp_server/methods/depth_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/depth_rows.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

std::size_t count_below_here(const float* depths, std::size_t count, float limit) {
    const std::size_t lanes = hn::Lanes(DF{});
    std::size_t below = 0;
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        below += hn::CountTrue(DF{}, hn::Lt(hn::LoadU(DF{}, depths + i), hn::Set(DF{}, limit)));
    }
    for (; i < count; ++i) below += depths[i] < limit ? 1 : 0;
    return below;
}

void mark_coverage_here(const float* depths, std::size_t count, Coverage* coverage) {
    const hn::Rebind<std::uint8_t, DF> d8;
    auto* bytes = reinterpret_cast<std::uint8_t*>(coverage);
    const std::size_t lanes = hn::Lanes(DF{});
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        const auto reached = hn::Ge(hn::LoadU(DF{}, depths + i), hn::Zero(DF{}));
        const auto value = hn::IfThenElseZero(hn::RebindMask(DI{}, reached), hn::Set(DI{}, 1));
        hn::StoreU(hn::DemoteTo(d8, value), d8, bytes + i);
    }
    for (; i < count; ++i) coverage[i] = depths[i] >= 0.0F ? Coverage::reached : Coverage::hole;
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(count_below_here);
HWY_EXPORT(mark_coverage_here);

std::size_t count_below(const float* depths, std::size_t count, float limit) {
    return HWY_DYNAMIC_DISPATCH(count_below_here)(depths, count, limit);
}

void mark_coverage(const float* depths, std::size_t count, Coverage* coverage) {
    HWY_DYNAMIC_DISPATCH(mark_coverage_here)(depths, count, coverage);
}

}  // namespace lw
#endif
