#include "client_renderer/occluder_search.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "client_renderer/occluder_search.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "client_renderer/box_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

HWY_INLINE VF scores_of(const BoxVector& boxes, VF areas, const glm::vec3& eye_world) {
    const DF d;
    const auto beyond = [&](VF centre, VF half, float eye) HWY_ATTR {
        return hn::Max(hn::Sub(hn::Abs(hn::Sub(hn::Set(d, eye), centre)), half), hn::Zero(d));
    };
    const VF x = beyond(boxes.centre_x, boxes.half_x, eye_world.x);
    const VF y = beyond(boxes.centre_y, boxes.half_y, eye_world.y);
    const VF z = beyond(boxes.centre_z, boxes.half_z, eye_world.z);
    const VF distance_2 = hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
    return hn::Div(areas, hn::Add(distance_2, hn::Set(d, 1.0F)));
}

void append_worth_here(const WideBvh& tree, const WideBvh::Child& node, const float* areas, const OccluderQuery& query,
                       const OcclusionBuffer& buffer, std::vector<OccluderCandidate>& candidates) {
    const DF d;
    const auto lanes = static_cast<std::uint32_t>(hn::Lanes(d));
    const std::uint32_t end = node.first + node.slot_count;
    for (std::uint32_t first = node.first; first < end; first += lanes) {
        const BoxVector boxes = load_boxes(tree.block(first).boxes, first % WideBvh::kMostChildren);
        const VF scores = scores_of(boxes, hn::LoadU(d, areas + first), query.eye_world);
        const MF wanted = hn::And(in_frustum(boxes, query.frustum, FloatFrustum::kAllPlanes),
                                  hn::Ge(scores, hn::Set(d, query.least_score)));
        std::uint32_t bits = bits_of(wanted) & lowest_bits(std::min(lanes, end - first));
        if (bits == 0) continue;
        bits &= ~hidden_of(buffer, project(boxes, buffer.view(), bits), bits);
        HWY_ALIGN std::array<float, kMaxLanes> stored;
        hn::Store(scores, d, stored.data());
        for (; bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
            const WideBvh::Child& child = tree.child(first + lane);
            if (child.is_item() && child.first >= query.end) continue;
            candidates.emplace_back(stored[lane], first + lane);
        }
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(append_worth_here);

// The bits of positive floats are in the order of their values.
OccluderCandidate::OccluderCandidate(float score, std::uint32_t slot)
    : key_{std::uint64_t{std::bit_cast<std::uint32_t>(score)} << 32U | std::uint32_t{~slot}} {}

void append_worth(const WideBvh& tree, const WideBvh::Child& node, const float* areas, const OccluderQuery& query,
                  const OcclusionBuffer& buffer, std::vector<OccluderCandidate>& candidates) {
    HWY_DYNAMIC_DISPATCH(append_worth_here)(tree, node, areas, query, buffer, candidates);
}

}  // namespace lw
#endif
