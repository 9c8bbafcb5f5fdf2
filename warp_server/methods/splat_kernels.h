#pragma once
/// The inner loops of `splat`, compiled for every instruction set and chosen at run time. All of them compute with
/// plain IEEE operations (no fused multiply-add, no reciprocal estimates), so every one gives the same bytes.

#include <cstdint>
#include <glm/glm.hpp>

#include "frame_link/rendered_frame.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/winner_rule.h"
#include "warp_server/warp_method.h"

namespace lw {

struct SplatInput {
    const CpuPixels* pixels = nullptr;
    const ObjectMatrices* matrices = nullptr;
};

/// Writes the points of the source rows `source_rows` into `keys`, which has the target's size. Background of object 0
/// is left to resolve_keys. Bad pixels are counted. Threads may run it at once on keys of their own.
/// @return the rows of `keys` that may have been written
RowRange splat_points(const SplatInput& input, RowRange source_rows, Image<WinnerKey>& keys, WarpCounters& counters);

/// Where the background comes from: a target pixel that no point reached shows the source pixel in its direction when
/// that one is background.
struct BackgroundLookup {
    glm::mat3 source_px_from_target_px{1.0F};  ///< homography of the rotation, columns x, y, 1
};

/// Lets the keys of `rows` in `from` compete with those in `into`, and clears them.
void merge_keys(RowRange rows, Image<WinnerKey>& from, Image<WinnerKey>& into);

/// Turns the keys of `target_rows` into colour, depth and coverage, and leaves those keys 0 for the next frame.
void resolve_keys(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows,
                  Image<WinnerKey>& keys, DisplayFrame& out);

}  // namespace lw
