#include "client_renderer/box_list.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/box_list.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <bit>

#include "client_renderer/box_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

void append_seen_here(const BoxList& boxes, const FloatFrustum& frustum, std::vector<std::uint32_t>& seen) {
    const std::size_t lanes = hn::Lanes(DF{});
    const std::size_t first_new = seen.size();
    seen.resize(first_new + boxes.size() + lanes);
    std::uint32_t* out = seen.data() + first_new;
    for (std::size_t i = 0; i < boxes.size(); i += lanes) {
        std::uint32_t bits = bits_of(in_frustum(load_boxes(boxes, i), frustum, FloatFrustum::kAllPlanes));
        for (; bits != 0; bits &= bits - 1) {
            *out++ = static_cast<std::uint32_t>(i) + static_cast<std::uint32_t>(std::countr_zero(bits));
        }
    }
    seen.resize(static_cast<std::size_t>(out - seen.data()));
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(append_seen_here);

namespace {
constexpr std::size_t kMostLanes = 64;  // of any vector we run on
}

void BoxList::resize(std::size_t count) {
    size_ = count;
    // A vector may begin at any box.
    stride_ = (count / kMostLanes + 2) * kMostLanes;
    rows_.assign(6 * stride_, 0.0F);
    for (std::size_t i = 3 * stride_; i < 4 * stride_; ++i) rows_[i] = -1.0F;
}

void BoxList::set(std::size_t index, const scene::Bounds& bounds_world) {
    const bool empty = bounds_world.empty();
    const glm::dvec3 centre = empty ? glm::dvec3{0.0} : bounds_world.centre();
    const glm::dvec3 half = empty ? glm::dvec3{-1.0} : bounds_world.half_size();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<glm::length_t>(axis);
        rows_[axis * stride_ + index] = static_cast<float>(centre[a]);
        rows_[(3 + axis) * stride_ + index] = static_cast<float>(half[a]);
    }
}

void BoxList::append_seen(const Frustum& frustum, std::vector<std::uint32_t>& seen) const {
    HWY_DYNAMIC_DISPATCH(append_seen_here)(*this, rounded(frustum), seen);
}

}  // namespace lw
#endif
