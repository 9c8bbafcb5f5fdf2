#pragma once
/// The reprojection chain, and its scalar double-precision kernel: where a source pixel belongs in the target.

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/camera.h"
#include "core/object_transform.h"
#include "core/transform.h"

namespace lw {

class TaskPool;

/// One matrix per object (seed document 004, p. 57):
///   target_px_from_target_clip * target_clip_from_target_eye * target_eye_from_world(photon)
///   * world_from_object(photon) * object_from_world(source) * world_from_source_eye * source_eye_from_source_px.
/// Apply it to (x_px, y_px, 1, depth); the result is w * (x_px, y_px, depth, 1). w <= 0 is behind the target eye.
/// Composed relative to the source eye, so a camera 10,000 km from the origin loses nothing. Pure, any thread.
[[nodiscard]] Transform<TargetPx, SourcePx> static_target_px_from_source_px(const Camera& source, const Camera& target);

/// The same for a mover that stood at `at_source` when the layer was drawn and stands at `at_target` at photon time.
/// @return nothing when `at_source` is not invertible (is_invertible_placement()), when `at_target` is no placement, or
/// when a product is beyond what a float holds. Pure, any thread.
[[nodiscard]] std::optional<Transform<TargetPx, SourcePx>> mover_target_px_from_source_px(const Camera& source,
                                                                                          const Camera& target,
                                                                                          const glm::dmat4& at_source,
                                                                                          const glm::dmat4& at_target);

/// A source sample placed in the target.
struct ReprojectedSample {
    glm::dvec2 position_px{0.0};
    double depth = 0.0;  ///< reversed; above 1 means nearer than the target's near plane: skip it, as GL clips it
    double w = 0.0;
};

/// Scalar kernel. `position_px` in source pixels, `depth` in [0, 1].
/// @return nothing for non-finite input and for w <= 0 (behind the target eye). Pure, any thread.
[[nodiscard]] std::optional<ReprojectedSample> reproject(const Transform<TargetPx, SourcePx>& target_px_from_source_px,
                                                         const glm::dvec2& position_px, double depth);

/// The per-object matrices of one layer for one display frame, as a dense table over object ids.
class ReprojectionTable {
public:
    /// `at_source` and `at_target` may be in any order. A mover without a (usable) target transform holds its source
    /// one; an id without a (usable) source transform has no matrix. Object 0 always has one. Reuses its memory: no
    /// allocation once the largest id was seen. One thread at a time.
    /// With `threads` the ids are shared out.
    void build(const Camera& source, const Camera& target, std::span<const ObjectTransform> at_source,
               std::span<const ObjectTransform> at_target, TaskPool* threads = nullptr);

    /// Largest id with an entry, plus one; at least 1 after build().
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

    /// Nothing for an id without a matrix: its pixels are counted and skipped.
    [[nodiscard]] const Transform<TargetPx, SourcePx>* find(ObjectId id) const {
        return id < entries_.size() && entries_[id].valid ? &entries_[id].target_px_from_source_px : nullptr;
    }

private:
    struct Entry {
        Transform<TargetPx, SourcePx> target_px_from_source_px;
        bool valid = false;
    };
    std::vector<Entry> entries_;
    std::vector<const glm::dmat4*> source_by_id_;
    std::vector<const glm::dmat4*> target_by_id_;
};

}  // namespace lw
