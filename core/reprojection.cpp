#include "core/reprojection.h"

#include <algorithm>
#include <cmath>

namespace lw {
namespace {

using EyeFromPx = Transform<SourceEye, SourcePx>;

bool is_finite(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) return false;
        }
    }
    return true;
}

// World space shifted to the source eye: positions near the eye stay small numbers however far the eye is from the
// world's origin.
glm::dmat4 relative_to(const glm::dvec3& origin_world, glm::dmat4 world_from_local) {
    world_from_local[3] -= glm::dvec4{origin_world, 0.0} * world_from_local[3].w;
    return world_from_local;
}

Transform<TargetEye, World> target_eye_from_shifted_world(const Camera& source, const Camera& target) {
    Pose shifted = target.world_from_eye;
    shifted.position_m -= source.world_from_eye.position_m;
    return {inverse_matrix_of(shifted)};
}

Transform<World, SourceEye> shifted_world_from_source_eye(const Camera& source) {
    return {matrix_of(Pose{glm::dvec3{0.0}, source.world_from_eye.orientation})};
}

}  // namespace

Transform<TargetPx, SourcePx> static_target_px_from_source_px(const Camera& source, const Camera& target) {
    return target_px_from_target_clip(target) * target_clip_from_target_eye(target) *
           (target_eye_from_shifted_world(source, target) * shifted_world_from_source_eye(source)) *
           source_eye_from_source_px(source);
}

std::optional<Transform<TargetPx, SourcePx>> mover_target_px_from_source_px(const Camera& source, const Camera& target,
                                                                            const glm::dmat4& at_source,
                                                                            const glm::dmat4& at_target) {
    const glm::dvec3 origin = source.world_from_eye.position_m;
    const Transform<World, Object> shifted_world_from_object_target{relative_to(origin, at_target)};
    const Transform<World, Object> shifted_world_from_object_source{relative_to(origin, at_source)};
    const Transform<Object, World> object_from_shifted_world = inverse(shifted_world_from_object_source);
    const auto target_px_from_source_px =
        target_px_from_target_clip(target) * target_clip_from_target_eye(target) *
        (target_eye_from_shifted_world(source, target) * shifted_world_from_object_target * object_from_shifted_world *
         shifted_world_from_source_eye(source)) *
        source_eye_from_source_px(source);
    if (!is_finite(target_px_from_source_px.matrix)) return std::nullopt;
    return target_px_from_source_px;
}

std::optional<ReprojectedSample> reproject(const Transform<TargetPx, SourcePx>& target_px_from_source_px,
                                           const glm::dvec2& position_px, double depth) {
    const glm::dvec4 h = target_px_from_source_px.matrix * glm::dvec4{position_px, 1.0, depth};
    if (!(h.w > 0.0) || !std::isfinite(h.x) || !std::isfinite(h.y) || !std::isfinite(h.z)) return std::nullopt;
    const ReprojectedSample sample{glm::dvec2{h} / h.w, h.z / h.w, h.w};
    if (!std::isfinite(sample.position_px.x) || !std::isfinite(sample.position_px.y) || !std::isfinite(sample.depth)) {
        return std::nullopt;
    }
    return sample;
}

void ReprojectionTable::build(const Camera& source, const Camera& target, std::span<const ObjectTransform> at_source,
                              std::span<const ObjectTransform> at_target) {
    ObjectId largest = 0;
    for (const ObjectTransform& object : at_source) largest = std::max(largest, object.id);

    target_by_id_.assign(std::size_t{largest} + 1, nullptr);
    for (const ObjectTransform& object : at_target) {
        if (object.id <= largest) target_by_id_[object.id] = &object.world_from_object;
    }

    entries_.assign(std::size_t{largest} + 1, Entry{});
    for (const ObjectTransform& object : at_source) {
        const glm::dmat4& at_source_time = object.world_from_object;
        const glm::dmat4* at_photon = target_by_id_[object.id];
        const auto matrix = mover_target_px_from_source_px(source, target, at_source_time,
                                                           at_photon != nullptr ? *at_photon : at_source_time);
        if (matrix) entries_[object.id] = {*matrix, true};
    }
    entries_[0] = {static_target_px_from_source_px(source, target), true};
}

}  // namespace lw
