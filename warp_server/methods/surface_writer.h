#pragma once
/// Adding patches to the lists of a prepared surface.

#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_links.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw {

/// Depth over a block, at the centre of its first pixel.
struct BlockPlane {
    ObjectId id = 0;
    float depth = 0.0F;
    float gradient_x = 0.0F;
    float gradient_y = 0.0F;

    [[nodiscard]] float at(int dx, int dy) const {
        return depth + static_cast<float>(dx) * gradient_x + static_cast<float>(dy) * gradient_y;
    }
};

/// Where a block of cells begins or ends along one axis, relative to its first pixel.
struct PatchExtent {
    float begin = 0.0F;
    float end = 0.0F;
};

/// Cells [first, end) of those from `origin` on, in an image of `size` pixels along the axis. They reach `overlap`
/// further, and at the rim of the image half a pixel, to the image's edge; the last cells half as far.
[[nodiscard]] inline PatchExtent patch_extent(int origin, int first, int end, int size, PatchOverlap overlap) {
    const bool at_begin = origin + first == 0;
    const bool at_end = origin + end == size;
    return {at_begin ? -0.5F : static_cast<float>(first) - overlap.before_px,
            at_end ? static_cast<float>(end) - 0.5F : static_cast<float>(end) + overlap.after_px};
}

/// One thread at a time.
class PatchWriter {
public:
    /// `links` outlives this.
    explicit PatchWriter(const SurfaceLinks& links) : links_{&links}, size_px_{links.size_px()} {}

    /// The cells from (x, y) on, `size` of them along both axes, less where the image ends. `corners` as PatchList has
    /// them.
    void add(PatchList& list, int x, int y, glm::ivec2 size, const BlockPlane& plane, std::uint8_t corners) const;

    /// One surface of the cell at (x, y), on the plane through its own corners; nothing when their depth is unusable.
    void add_cell_surface(PatchList& list, int x, int y, std::uint8_t corners) const;

private:
    const SurfaceLinks* links_;
    glm::ivec2 size_px_;
};

}  // namespace lw
