#include "client_renderer/box_list.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/box_list.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cmath>

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::ScalableTag<float>;
using VF = hn::Vec<DF>;

// Single precision: six products and sums of magnitudes below the sum used, each rounded by 6e-8, and the rounding of
// the boxes themselves.
constexpr float kRounding = 2e-6F;

void append_seen_here(const BoxList& boxes, const Frustum& frustum, std::vector<std::uint32_t>& seen) {
    const DF d;
    const std::size_t lanes = hn::Lanes(d);
    std::array<const float*, 6> rows{};
    for (int i = 0; i < 6; ++i) rows[static_cast<std::size_t>(i)] = boxes.row(i);
    const std::size_t first_new = seen.size();
    seen.resize(first_new + boxes.size() + lanes);
    std::uint32_t* out = seen.data() + first_new;
    for (std::size_t i = 0; i < boxes.size(); i += lanes) {
        const VF cx = hn::LoadU(d, rows[0] + i);
        const VF cy = hn::LoadU(d, rows[1] + i);
        const VF cz = hn::LoadU(d, rows[2] + i);
        const VF hx = hn::LoadU(d, rows[3] + i);
        const VF hy = hn::LoadU(d, rows[4] + i);
        const VF hz = hn::LoadU(d, rows[5] + i);
        auto inside = hn::Ge(hx, hn::Zero(d));  // empty boxes have a negative size
        for (const glm::dvec4& plane : frustum.planes) {
            const VF nx = hn::Set(d, static_cast<float>(plane.x));
            const VF ny = hn::Set(d, static_cast<float>(plane.y));
            const VF nz = hn::Set(d, static_cast<float>(plane.z));
            const VF w = hn::Set(d, static_cast<float>(plane.w));
            const VF reach = hn::MulAdd(hn::Abs(nx), hx, hn::MulAdd(hn::Abs(ny), hy, hn::Mul(hn::Abs(nz), hz)));
            const VF place = hn::MulAdd(nx, cx, hn::MulAdd(ny, cy, hn::MulAdd(nz, cz, w)));
            const VF size = hn::Add(hn::Add(hn::Abs(cx), hn::Abs(cy)), hn::Add(hn::Abs(cz), hn::Abs(w)));
            const VF allowed = hn::Mul(hn::Set(d, -kRounding), hn::Add(size, reach));
            inside = hn::And(inside, hn::Ge(hn::Add(place, reach), allowed));
        }
        std::array<std::uint8_t, 8> bytes{};
        hn::StoreMaskBits(d, inside, bytes.data());
        auto bits = std::bit_cast<std::uint64_t>(bytes);
        if (lanes < 64) bits &= (std::uint64_t{1} << lanes) - 1;
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
    stride_ = (count + kMostLanes - 1) / kMostLanes * kMostLanes;
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
    HWY_DYNAMIC_DISPATCH(append_seen_here)(*this, frustum, seen);
}

}  // namespace lw
#endif
