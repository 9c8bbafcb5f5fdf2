#include "client_renderer/culling.h"

#include <bit>
#include <numeric>

namespace lw {

Culling::Culling(const PlacedInstances& placed, const CullingSettings& settings)
    : placed_{placed}, settings_{settings}, occluders_{placed} {
    if (placed.size() > kListUpTo) {
        for (const PlacedInstance& instance : placed.all()) bounds_.push_back(instance.bounds_world);
        tree_.emplace(bounds_);
        marks_.assign(placed.size() / 64 + 1, 0);
        return;
    }
    boxes_.resize(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) boxes_.set(i, placed[i].bounds_world);
}

void Culling::move() {
    for (const std::uint32_t mover : placed_.movers()) {
        if (tree_) {
            bounds_[mover] = placed_[mover].bounds_world;
        } else {
            boxes_.set(mover, placed_[mover].bounds_world);
        }
    }
    if (tree_) tree_->move(placed_.movers(), bounds_);
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
    buffer_.begin(camera);
    counters_.occluders = occluders_.draw(camera, settings_.reveal_margin_m, buffer_);
    const bool with_occlusion = counters_.occluders > 0;
    if (with_occlusion) buffer_.finish();
    if (tree_) {
        walk_tree(camera, with_occlusion);
    } else {
        walk_list(camera, with_occlusion);
    }
    counters_.outside = placed_.size() - seen_.size() - counters_.occluded;
    return seen_;
}

ClusterView Culling::cluster_view(const Camera& camera) const {
    return {frustum_of(camera), camera.world_from_eye.position_m, settings_.reveal_margin_m,
            counters_.occluders > 0 ? &buffer_ : nullptr};
}

void Culling::walk_list(const Camera& camera, bool with_occlusion) {
    if (!with_occlusion) {
        boxes_.append_seen(frustum_of(camera), seen_);
        return;
    }
    in_view_.clear();
    boxes_.append_seen(frustum_of(camera), in_view_);
    hidden_.clear();
    buffer_.split(boxes_, in_view_, seen_, hidden_);
    counters_.occluded = hidden_.size();
}

void Culling::walk_tree(const Camera& camera, bool with_occlusion) {
    WalkQuery query;
    query.frustum = rounded(frustum_of(camera));
    if (with_occlusion) query.occlusion = &buffer_;
    in_view_.clear();
    tree_->append_seen(query, in_view_);
    counters_.occluded = tree_->counters().items_hidden;
    // Objects are drawn in the order of their indices.
    for (const std::uint32_t object : in_view_) marks_[object / 64] |= std::uint64_t{1} << (object % 64);
    for (std::size_t word = 0; word < marks_.size(); ++word) {
        for (std::uint64_t bits = marks_[word]; bits != 0; bits &= bits - 1) {
            seen_.push_back(static_cast<std::uint32_t>(64 * word) + static_cast<std::uint32_t>(std::countr_zero(bits)));
        }
        marks_[word] = 0;
    }
}

}  // namespace lw
