#pragma once
/// The inner loops that find the background of holes, on the widest vectors the machine has.

#include <cstdint>
#include <limits>

#include "warp_server/warp_method.h"

namespace lw {

/// A reached pixel that a hole may copy. One that does not exist is infinitely near, so it is never chosen.
struct FillEnd {
    float depth = std::numeric_limits<float>::infinity();
    std::int32_t index = -1;  ///< of the pixel in the image
};

/// What a pixel of distance costs along each side, where ends compete: dearer to the side that hid the background.
struct FillCosts {
    std::int32_t left = 1;
    std::int32_t right = 1;
    std::int32_t above = 1;
    std::int32_t below = 1;
};

/// The hole pixels [begin, end) of row y, and what ends their rows and columns.
struct FillRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    int width = 0;                            ///< of the image
    FillEnd left;                             ///< beside `begin`
    FillEnd right;                            ///< beside `end`
    const std::int32_t* row_above = nullptr;  ///< per pixel of the run, -1 for none
    const float* depth_above = nullptr;       ///< infinity for none
    const std::int32_t* row_below = nullptr;
    const float* depth_below = nullptr;
    FillCosts costs;
};

/// Ends of one surface seen at a slant differ by a few percent in depth; then the nearer end looks better.
inline constexpr float kSameDepthPart = 0.1F;

/// For each pixel of the run the index of the one to copy, -1 where there is none, and its cost, which is its
/// distance by FillCosts. Along row and column each the farther end, or the cheaper where both are about as far. Of row
/// and column the one whose other end is nearer, as it must be where a foreground uncovers its background; the cheaper
/// where both have such an end; where none has, again the farther one, or the cheaper where both are about as far. (The
/// cheaper one alone would take a railing's bar beside a hole far behind it, the farther one alone a house above a car
/// that drove off.)
void choose_background(const FillRun& run, std::int32_t* chosen, std::int32_t* cost);

/// Columns [begin, end): where `beside` is no hole, `rows` and `depths` take that row and its depth.
void follow_columns(int begin, int end, int row_beside, const Coverage* beside, const float* depth_beside,
                    std::int32_t* rows, float* depths);

}  // namespace lw
