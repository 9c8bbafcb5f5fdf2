#include "client_renderer/culling.h"

#include <bit>
#include <numeric>
#include <vector>

namespace lw {

Culling::Culling(const PlacedInstances& placed, const CullingSettings& settings, TaskPool* threads)
    : placed_{placed},
      settings_{settings},
      threads_{threads},
      portals_{placed},
      marks_(placed.size() / 64 + 1, 0),
      occluders_{placed} {
    boxes_.resize(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) boxes_.set(i, placed[i].bounds_world);
    if (placed.size() <= kListUpTo) return;
    for (const PlacedInstance& instance : placed.all()) bounds_.push_back(instance.bounds_world);
    tree_.emplace(bounds_);
}

// Neither task needs the other.
void Culling::prepare(const Camera& camera) {
    if (threads_ != nullptr && moved_ && settings_.occlusion) {
        threads_->run(2,
                      [this, &camera](int task, int /*worker*/) { task == 0 ? draw_occluders(camera) : move_boxes(); });
    } else {
        draw_occluders(camera);
        move_boxes();
    }
    moved_ = false;
}

void Culling::move_boxes() {
    if (!moved_) return;
    for (const std::uint32_t mover : placed_.movers()) {
        if (tree_) bounds_[mover] = placed_[mover].bounds_world;
        if (!tree_ || !portals_.empty()) boxes_.set(mover, placed_[mover].bounds_world);
    }
    if (tree_) tree_->move(placed_.movers(), bounds_);
}

void Culling::draw_occluders(const Camera& camera) {
    buffer_.begin(camera);
    if (!settings_.occlusion) return;
    if (moved_) occluders_.move(placed_);
    counters_.occluders = occluders_.draw(camera, settings_.reveal_margin_m, buffer_);
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
    prepare(camera);
    const bool with_occlusion = counters_.occluders > 0;
    in_view_.clear();
    if (settings_.portals && !portals_.empty() && portals_.append_seen(camera, settings_.reveal_margin_m, in_view_)) {
        walk_portals(camera, with_occlusion);
    } else if (tree_) {
        walk_tree(camera, with_occlusion);
    } else {
        walk_list(camera, with_occlusion);
    }
    counters_.outside = placed_.size() - seen_.size() - counters_.occluded - counters_.behind_walls -
                        counters_.too_small - counters_.between_samples;
    return seen_;
}

ClusterView Culling::cluster_view(const Camera& camera) const {
    return {frustum_of(camera),
            camera.world_from_eye.position_m,
            settings_.reveal_margin_m,
            buffer_.view(),
            counters_.occluders > 0 ? &buffer_ : nullptr,
            least_size_per_distance(camera)};
}

double Culling::least_size_per_distance(const Camera& camera) const {
    if (!viewer_moves_) return 0.0;
    return settings_.min_pixels * (camera.fov.up - camera.fov.down) / camera.size_px.y;
}

void Culling::leave_out_small(const Camera& camera, std::vector<std::uint32_t>& objects) {
    const double least = least_size_per_distance(camera);
    if (!(least > 0.0)) return;
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    counters_.too_small += std::erase_if(objects, [&](std::uint32_t object) {
        const scene::Bounds& box = placed_[object].bounds_world;
        return 2.0 * glm::length(box.half_size()) < least * glm::distance(box.centre(), eye_world);
    });
}

void Culling::walk_list(const Camera& camera, bool with_occlusion) {
    if (!with_occlusion) {
        boxes_.append_seen(frustum_of(camera), seen_);
        leave_out_small(camera, seen_);
        return;
    }
    boxes_.append_seen(frustum_of(camera), in_view_);
    leave_out_small(camera, in_view_);
    count(buffer_.split(boxes_, in_view_, seen_));
}

void Culling::count(const OcclusionBuffer::Split& split) {
    counters_.occluded = split.hidden;
    counters_.between_samples = split.between_samples;
}

void Culling::walk_tree(const Camera& camera, bool with_occlusion) {
    WalkQuery query;
    query.frustum = rounded(frustum_of(camera));
    if (with_occlusion) query.occlusion = &buffer_;
    query.least_size_per_distance = static_cast<float>(least_size_per_distance(camera));
    for (int i = 0; i < 3; ++i) {
        query.eye_world[static_cast<std::size_t>(i)] = static_cast<float>(camera.world_from_eye.position_m[i]);
    }
    tree_->append_seen(query, in_view_, threads_);
    counters_.occluded = tree_->counters().items_hidden;
    counters_.too_small = tree_->counters().items_too_small;
    counters_.between_samples = tree_->counters().items_between_samples;
    put_in_order();
}

void Culling::walk_portals(const Camera& camera, bool with_occlusion) {
    counters_.behind_walls = placed_.size() - in_view_.size();
    leave_out_small(camera, in_view_);
    if (with_occlusion) {
        shown_.clear();
        count(buffer_.split(boxes_, in_view_, shown_));
        in_view_.swap(shown_);
    }
    put_in_order();
}

void Culling::put_in_order() {
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
