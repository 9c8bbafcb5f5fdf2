#include "frame_link/sampled_mover_feed.h"

#include <algorithm>
#include <cmath>

#include "frame_link/velocity_fit.h"

namespace lw {
namespace {

constexpr Duration kLongestSpan = std::chrono::seconds{1};

bool is_finite(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(matrix[column][row])) return false;
        }
    }
    return true;
}

/// The rotation of a placement without its scale; a mirrored one is turned about its mirror.
std::optional<glm::dquat> rotation_of(const glm::dmat4& placement) {
    glm::dmat3 axes{placement};
    for (int i = 0; i < 3; ++i) {
        const double length = glm::length(axes[i]);
        if (length < 1e-12) return std::nullopt;
        axes[i] /= length;
    }
    if (glm::determinant(axes) < 0.0) axes = -axes;
    return glm::normalize(glm::quat_cast(axes));
}

}  // namespace

glm::dmat4 carried_on(const glm::dmat4& before, const glm::dmat4& newest, double span_s, double seconds) {
    const double share = seconds / span_s;
    glm::dmat4 placement = newest;
    const auto from = rotation_of(before);
    const auto to = rotation_of(newest);
    if (from && to) {
        const glm::dvec3 turned = rotation_vector(*to * glm::conjugate(*from));
        const glm::dmat3 axes = glm::mat3_cast(from_rotation_vector(turned * share)) * glm::dmat3{newest};
        for (int i = 0; i < 3; ++i) placement[i] = glm::dvec4{axes[i], 0.0};
    }
    placement[3] = newest[3] + (newest[3] - before[3]) * share;
    return placement;
}

bool SampledMoverFeed::push(TimePoint time, std::span<const ObjectTransform> placements) {
    const auto old = updates();
    if (old && time <= old->newest.time) return false;
    auto fresh = std::make_shared<Updates>();
    fresh->newest.time = time;
    for (const ObjectTransform& placement : placements) {
        if (is_finite(placement.world_from_object)) fresh->newest.placements.push_back(placement);
    }
    fresh->has_before = old && time - old->newest.time <= kLongestSpan;
    if (fresh->has_before) fresh->before = old->newest;
    const std::lock_guard lock{mutex_};
    updates_ = std::move(fresh);
    return true;
}

void SampledMoverFeed::placements_at(TimePoint time, std::vector<ObjectTransform>& transforms) const {
    transforms.clear();
    const auto known = updates();
    if (!known) return;
    transforms = known->newest.placements;
    if (!known->has_before) return;
    const double span_s = to_seconds(known->newest.time - known->before.time);
    const double seconds = std::max(-span_s, steady_span(to_seconds(time - known->newest.time)));
    auto before = known->before.placements.begin();
    const auto end = known->before.placements.end();
    for (ObjectTransform& placement : transforms) {
        while (before != end && before->id < placement.id) ++before;
        if (before == end || before->id != placement.id) continue;
        placement.world_from_object =
            carried_on(before->world_from_object, placement.world_from_object, span_s, seconds);
    }
}

std::shared_ptr<const SampledMoverFeed::Updates> SampledMoverFeed::updates() const {
    const std::lock_guard lock{mutex_};
    return updates_;
}

}  // namespace lw
