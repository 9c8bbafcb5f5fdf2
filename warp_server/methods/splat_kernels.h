#pragma once
/// The inner loops of `splat`, compiled for every instruction set and chosen at run time. All of them compute with
/// plain IEEE operations (no fused multiply-add, no reciprocal estimates), so every one gives the same bytes.

#include <span>

#include "warp_server/methods/key_ring.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_input.h"
#include "warp_server/methods/splat_reach.h"

namespace lw {

/// Writes the points of one band of the source into `keys`, as far as they land in its columns and in `target_rows`,
/// which are at most as many as the ring has slots. Background of object 0 is left to resolve_rows.
/// @param landings  of the band's tiles
void splat_band(const SplatInput& input, int band, std::span<const TileLanding> landings, RowRange target_rows,
                KeyRing& keys);

}  // namespace lw
