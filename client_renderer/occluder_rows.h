#pragma once
/// Houses in a row hide as one wall: without the seams between them.

#include <vector>

#include "client_renderer/occluders.h"

namespace lw {

/// Appends solids that span two and more axis-aligned ones which touch: their common cross-section along the whole row.
void append_rows(std::vector<Occluder>& occluders);

}  // namespace lw
