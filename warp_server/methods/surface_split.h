#pragma once
/// Cutting a patch into smaller ones of the same plane.

#include <cstdint>

#include "warp_server/methods/surface_classify.h"

namespace lw {

/// Appends the up to four quarters of patch `index` to `parts`; nothing for a patch of one cell.
void split_patch(const PatchList& list, std::uint32_t index, PatchList& parts);

}  // namespace lw
