#pragma once
/// The search of `inverse`, compiled for every instruction set and chosen at run time; the same bytes on all.

#include <glm/glm.hpp>

#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/row_range.h"

namespace lw {

/// A search that ended farther than this from its pixel found no surface there.
inline constexpr float kAcceptedErrorPx = 1.0F;

struct InverseInput {
    const CpuPixels* pixels = nullptr;
    const LinearImage* linear = nullptr;
    const ObjectMatrices* matrices = nullptr;
    glm::mat3 source_from_target{1.0F};  ///< where the search begins: pixels, for a head that only turned
    int steps = 3;
};

/// Searches for every pixel in the rows `rows` of `out`, which it overwrites. Any number of threads, rows of their own.
void search_rows(const InverseInput& input, RowRange rows, DisplayFrame& out);

}  // namespace lw
