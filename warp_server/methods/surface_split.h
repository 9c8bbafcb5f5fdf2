#pragma once
/// Cutting a patch into smaller ones of the same plane.

#include <cstdint>

#include "warp_server/methods/surface_classify.h"

namespace lw {

/// Appends the up to four quarters of patch `index` to `parts`; nothing for a patch of one cell.
void split_patch(const PatchList& list, std::uint32_t index, PatchList& parts);

/// Appends the cells of surface `index`: those wholly on it to `whole`, as long as they are side by side in one patch;
/// those in which it meets others to `edges`.
void split_tile(const SurfaceTiles& tiles, std::size_t index, PatchList& whole, PatchList& edges);

}  // namespace lw
