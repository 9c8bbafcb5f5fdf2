#include "client_renderer/culling.h"

#include <numeric>

namespace lw {

Culling::Culling(const PlacedInstances& placed, const CullingSettings& settings)
    : placed_{placed}, settings_{settings}, occluders_{placed} {
    boxes_.resize(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) boxes_.set(i, placed[i].bounds_world);
}

void Culling::move() {
    for (const std::uint32_t mover : placed_.movers()) boxes_.set(mover, placed_[mover].bounds_world);
    occluders_.move(placed_);
}

const std::vector<std::uint32_t>& Culling::visible(const Camera& camera) {
    counters_ = {};
    counters_.tested = placed_.size();
    seen_.clear();
    if (!settings_.skip) {
        seen_.resize(placed_.size());
        std::iota(seen_.begin(), seen_.end(), 0U);
        return seen_;
    }
    in_view_.clear();
    boxes_.append_seen(frustum_of(camera), in_view_);
    counters_.outside = placed_.size() - in_view_.size();

    buffer_.begin(camera);
    counters_.occluders = occluders_.draw(camera, settings_.reveal_margin_m, buffer_);
    if (counters_.occluders == 0) return in_view_;
    buffer_.finish();
    hidden_.clear();
    buffer_.split(boxes_, in_view_, seen_, hidden_);
    counters_.occluded = hidden_.size();
    return seen_;
}

}  // namespace lw
