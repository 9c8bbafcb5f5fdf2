#pragma once
/// The inner loop of `stale` and `rotation`, compiled for every instruction set and chosen at run time.

#include <cstdint>
#include <glm/glm.hpp>

#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/warp_method.h"

namespace lw {

/// What every target pixel needs.
struct HomographyInput {
    const CpuPixels* pixels = nullptr;
    const LinearImage* linear = nullptr;  ///< their colours
    glm::mat3 source_from_target{1.0F};   ///< pixels, columns x, y, 1
    float depth_scale = 1.0F;             ///< target depth = source depth * depth_scale * w of the homography
    bool has_empty_pixels = false;        ///< some of the source show nothing (kNoSurfaceDepth)
};

/// Resamples rows of the target as resample_by_rotation() says. Returns how many target pixels met a bad depth.
std::uint64_t resample_rows(const HomographyInput& input, RowRange rows, DisplayFrame& out);

}  // namespace lw
