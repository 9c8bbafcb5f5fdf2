#pragma once
/// Laying patches over the target: the inner loops of `surface`, compiled for every instruction set and chosen at run
/// time. All compute with plain IEEE and whole-number operations, so every one gives the same bytes.

#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_classify.h"

namespace lw {

struct PatchInput {
    const PreparedSurface* prepared = nullptr;
    const ObjectMatrices* matrices = nullptr;
    bool between_pixels = true;  ///< colours are read from the lattice, where there is one
};

/// Entries [begin, end) of a list.
struct ListRange {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Draws `range` of `list` where it is nearer than what the canvas shows: whole patches as opaque pixels, edge cells as
/// fragments. Patches that reach behind the target eye are left out and their indices appended to `behind`.
void draw_patches(const PatchInput& input, const PatchList& list, ListRange range, SurfaceCanvas& canvas,
                  std::vector<std::uint32_t>& behind);

/// The same for `prepared->tiles`.
void draw_tiles(const PatchInput& input, ListRange range, SurfaceCanvas& canvas, std::vector<std::uint32_t>& behind);

}  // namespace lw
