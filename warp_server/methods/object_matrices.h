#pragma once
/// The matrices of one layer for one display frame, rounded to float once, in the form per-pixel loops want.

#include <cstddef>
#include <vector>

#include "core/object_transform.h"
#include "core/reprojection.h"
#include "warp_server/warp_method.h"

namespace lw {

/// target_px_from_source_px of one object by columns: h = x * x_px + y * y_px + one + z * depth, with h = (x, y, w)
/// and the target position (h.x, h.y) / h.w in pixels. The target depth is depth_scale * depth / h.w: objects move by
/// affine transforms, so the depth row has no other entry.
struct PixelMatrix {
    struct Column {
        float x = 0.0F;
        float y = 0.0F;
        float w = 0.0F;
    };
    Column x;
    Column y;
    Column one;
    Column z;
    float depth_scale = 0.0F;
    /// About how far the object's pixels move from where a still picture shows them, if it is a metre away. Known for
    /// layers whose alpha is a share (CpuPixels), else 0.
    float moved_px = 0.0F;
    bool valid = false;     ///< false: the id has no usable placement, its pixels are counted and skipped
    bool identity = false;  ///< exactly the identity: every source pixel stays where it is
};

/// A matrix that moves no pixel of the layer by 1e-6 px becomes exactly the identity, so that the rounding of its
/// composition cannot disturb a still picture. `source_size_px` bounds the pixel coordinates. Pure, any thread.
[[nodiscard]] PixelMatrix pixel_matrix_of(const Transform<TargetPx, SourcePx>& target_px_from_source_px,
                                          glm::ivec2 source_size_px);

/// Dense table over object ids. Reuses its memory; one thread at a time builds, any number read.
class ObjectMatrices {
public:
    /// @param depth_share  target depths are multiplied by it (StackedLayer)
    /// @param threads      share the work, if there are any
    void build(const Layer& layer, const WarpTarget& target, float depth_share = 1.0F, TaskPool* threads = nullptr);

    /// At least 1: object 0 (sky and static world) is always valid.
    [[nodiscard]] std::size_t size() const { return matrices_.size(); }
    /// Null for an id without a usable placement.
    [[nodiscard]] const PixelMatrix* find(ObjectId id) const {
        return id < matrices_.size() && matrices_[id].valid ? &matrices_[id] : nullptr;
    }
    [[nodiscard]] const PixelMatrix* data() const { return matrices_.data(); }
    /// True when no object moves in the picture and source and target have the same size.
    [[nodiscard]] bool all_identity() const { return all_identity_; }
    /// The same matrices in double.
    [[nodiscard]] const ReprojectionTable& exact() const { return table_; }

private:
    ReprojectionTable table_;
    std::vector<PixelMatrix> matrices_;
    bool all_identity_ = false;
};

/// The layer's CPU pixels; programmer error when they are textures or an image's size differs from the camera's.
[[nodiscard]] const CpuPixels& checked_cpu_pixels(const Layer& layer);

/// Depth values that can be warped: finite, 0 (background) to 1 (near plane).
[[nodiscard]] inline bool is_usable_depth(float depth) { return depth >= 0.0F && depth <= 1.0F; }

}  // namespace lw
