#pragma once
/// What drawing with `surface` costs, and where: several threads share the target's rows.

#include <vector>

#include "core/image.h"
#include "warp_server/methods/row_costs.h"

namespace lw {

struct PixelMatrix;
struct PreparedSurface;

/// Of drawing each region of `prepared`, in pixels of a large block. Pure, any thread.
[[nodiscard]] std::vector<float> costs_of_regions(const PreparedSurface& prepared);

/// Adds to the rows of a picture what each region costs where it lands, as if movers stood still.
/// @param target_from_source  of what does not move
void add_costs(const PreparedSurface& prepared, const PixelMatrix& target_from_source, glm::ivec2 target_size_px,
               RowCosts& costs);

}  // namespace lw
