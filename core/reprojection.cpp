#include "core/reprojection.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "core/placement_check.h"
#include "core/task_pool.h"

namespace lw {
namespace {

using EyeFromPx = Transform<SourceEye, SourcePx>;

// Sums of four terms with pixel coordinates up to 1e5 stay below the largest float, 3e38.
constexpr double kLargestEntry = 1e30;

constexpr std::size_t kIdsPerTask = 64;  // some microseconds

bool fits_a_float(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!(std::abs(m[column][row]) <= kLargestEntry)) return false;
        }
    }
    return true;
}

// How an object moves the world between two times. An object's origin may be 10,000 km from its surface, and both
// placements are then large numbers whose difference counts: in double 5e-9 m of it would be lost, 0.01 px of something
// 1 cm away under a lens of 10,000 px per unit tangent.
using Wide = long double;
using WideMatrix = glm::mat<3, 3, Wide>;
using WideVector = glm::vec<3, Wide>;

// Axis by axis at length 1, so that neither scale nor a flat object costs digits. Invertible placements only.
WideMatrix inverse_axes(const glm::dmat4& world_from_object) {
    WideMatrix axes{glm::dmat3{world_from_object}};
    WideVector per_length{1};
    for (int axis = 0; axis < 3; ++axis) {
        per_length[axis] = Wide{1} / glm::length(axes[axis]);  // invertible: its square is far from the limits
        axes[axis] *= per_length[axis];
    }
    WideMatrix rows = glm::transpose(glm::inverse(axes));  // column i: row i of the inverse
    for (int axis = 0; axis < 3; ++axis) rows[axis] *= per_length[axis];
    return glm::transpose(rows);
}

// Both worlds are shifted to the source eye: positions near the eye stay small numbers however far the eye is from the
// world's origin.
glm::dmat4 motion_about(const glm::dvec3& origin_world, const glm::dmat4& at_source, const glm::dmat4& at_target) {
    const WideVector origin{origin_world};
    const WideMatrix linear = WideMatrix{glm::dmat3{at_target}} * inverse_axes(at_source);
    const WideVector shift =
        (WideVector{glm::dvec3{at_target[3]}} - origin) - linear * (WideVector{glm::dvec3{at_source[3]}} - origin);
    glm::dmat4 motion{glm::dmat3{linear}};
    motion[3] = glm::dvec4{glm::dvec3{shift}, 1.0};
    return motion;
}

// From a layer to the target: what all its objects have in common. The world is shifted, see motion_about().
class ViewChange {
public:
    ViewChange(const Camera& source, const Camera& target)
        : source_eye_world_{source.world_from_eye.position_m},
          target_px_from_shifted_world_{target_px_from_target_clip(target) * target_clip_from_target_eye(target) *
                                        target_eye_from_shifted_world(source, target)},
          shifted_world_from_source_px_{shifted_world_from_source_eye(source) * source_eye_from_source_px(source)},
          static_{target_px_from_shifted_world_ * shifted_world_from_source_px_} {}

    [[nodiscard]] Transform<TargetPx, SourcePx> of_static() const { return static_; }
    [[nodiscard]] std::optional<Transform<TargetPx, SourcePx>> of_mover(const glm::dmat4& at_source,
                                                                        const glm::dmat4& at_target) const {
        if (!is_invertible_placement(at_source) || !is_placement(at_target)) return std::nullopt;
        if (at_source == at_target) return of_static();
        const bool turned = glm::dmat3{at_source} != glm::dmat3{at_target};
        const auto target_px_from_source_px =
            turned ? of_turned(at_source, at_target) : of_slid(glm::dvec3{at_target[3]} - glm::dvec3{at_source[3]});
        if (!fits_a_float(target_px_from_source_px.matrix)) return std::nullopt;
        return target_px_from_source_px;
    }

private:
    [[nodiscard]] Transform<TargetPx, SourcePx> of_turned(const glm::dmat4& at_source,
                                                          const glm::dmat4& at_target) const {
        const Transform<World, World> motion{motion_about(source_eye_world_, at_source, at_target)};
        return target_px_from_shifted_world_ * motion * shifted_world_from_source_px_;
    }
    // Most movers slide: nothing to invert, and one outer product instead of two matrix products.
    [[nodiscard]] Transform<TargetPx, SourcePx> of_slid(const glm::dvec3& shift_world) const {
        const glm::dvec4 shift_px = target_px_from_shifted_world_.matrix * glm::dvec4{shift_world, 0.0};
        Transform<TargetPx, SourcePx> slid = static_;
        for (int column = 0; column < 4; ++column) {
            slid.matrix[column] += shifted_world_from_source_px_.matrix[column].w * shift_px;
        }
        return slid;
    }

    static Transform<TargetEye, World> target_eye_from_shifted_world(const Camera& source, const Camera& target) {
        Pose shifted = target.world_from_eye;
        shifted.position_m -= source.world_from_eye.position_m;
        return {inverse_matrix_of(shifted)};
    }
    static Transform<World, SourceEye> shifted_world_from_source_eye(const Camera& source) {
        return {matrix_of(Pose{glm::dvec3{0.0}, source.world_from_eye.orientation})};
    }

    glm::dvec3 source_eye_world_;
    Transform<TargetPx, World> target_px_from_shifted_world_;
    Transform<World, SourcePx> shifted_world_from_source_px_;
    Transform<TargetPx, SourcePx> static_;
};

}  // namespace

Transform<TargetPx, SourcePx> static_target_px_from_source_px(const Camera& source, const Camera& target) {
    return ViewChange{source, target}.of_static();
}

std::optional<Transform<TargetPx, SourcePx>> mover_target_px_from_source_px(const Camera& source, const Camera& target,
                                                                            const glm::dmat4& at_source,
                                                                            const glm::dmat4& at_target) {
    return ViewChange{source, target}.of_mover(at_source, at_target);
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
                              std::span<const ObjectTransform> at_target, TaskPool* threads) {
    ObjectId largest = 0;
    for (const ObjectTransform& object : at_source) largest = std::max(largest, object.id);
    const auto list = [&](std::span<const ObjectTransform> objects, std::vector<const glm::dmat4*>& by_id) {
        by_id.assign(std::size_t{largest} + 1, nullptr);
        for (const ObjectTransform& object : objects) {
            if (object.id <= largest) by_id[object.id] = &object.world_from_object;
        }
    };
    list(at_source, source_by_id_);
    list(at_target, target_by_id_);

    entries_.resize(std::size_t{largest} + 1);
    const ViewChange change{source, target};
    for_ranges(threads, entries_.size(), kIdsPerTask, [&](std::size_t begin, std::size_t end) {
        for (std::size_t id = begin; id < end; ++id) {
            Entry& entry = entries_[id];
            entry.valid = false;
            if (source_by_id_[id] == nullptr) continue;
            const glm::dmat4* at_photon = target_by_id_[id];
            const bool holds = at_photon == nullptr || !is_placement(*at_photon);
            const auto matrix = change.of_mover(*source_by_id_[id], holds ? *source_by_id_[id] : *at_photon);
            if (matrix) entry = {*matrix, true};
        }
    });
    entries_[0] = {change.of_static(), true};
}

}  // namespace lw
