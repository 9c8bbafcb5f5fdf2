#pragma once
/// The inner loops that find the background of holes, on the widest vectors the machine has.

#include <cstdint>
#include <vector>

#include "warp_server/methods/row_range.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Hole pixels [begin, end) of one row, between pixels that are none.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
};

/// The pixels of a run in some columns.
struct HolePart {
    HoleRun run;
    RowRange columns;
};

/// What a pixel of distance costs along each side, where ends compete: dearer to the side that hid the background.
struct FillCosts {
    std::int32_t left = 1;
    std::int32_t right = 1;
    std::int32_t above = 1;
    std::int32_t below = 1;
};

/// What walks along the columns of a picture carry from row to row, and what they find. One entry for each column; one
/// walk uses it at a time.
struct HoleScratch {
    void resize(int width);

    std::vector<std::int32_t> row_below;  ///< the next row below whose pixel was reached, -1 for none
    std::vector<std::int32_t> row_above;
    std::vector<float> depth_above;    ///< infinity for none
    std::vector<std::int32_t> chosen;  ///< index of the pixel to copy, -1 for none
    std::vector<float> depth;          ///< of that pixel
    std::vector<std::int32_t> cost;    ///< of its distance (FillCosts); larger than any other where there is none
};

/// Ends of one surface seen at a slant differ by a few percent in depth; then the nearer end looks better.
inline constexpr float kSameDepthPart = 0.1F;

/// One step of a walk up: leaves HoleScratch::row_below as the depth of each hole pixel of the part, bit by bit. The
/// depth of a hole means nothing else until it is filled.
void look_below(DisplayFrame& frame, const HolePart& part, HoleScratch& scratch);

/// One step of a walk down, after look_below() has been everywhere in the part's columns: for each hole pixel the pixel
/// to copy and its cost. Along row and column each the farther end, or the cheaper where both are about as far. Of row
/// and column the one whose other end is nearer, as it must be where a foreground uncovers its background; the cheaper
/// where both have such an end; where none has, again the farther one, or the cheaper where both are about as far. (The
/// cheaper one alone would take a railing's bar beside a hole far behind it, the farther one alone a house above a car
/// that drove off.)
void choose_background(const DisplayFrame& frame, const HolePart& part, const FillCosts& costs, HoleScratch& scratch);

/// Copies what was chosen for the pixels of the part; `nothing`, infinitely far away, where there is nothing.
void copy_background(DisplayFrame& frame, const HolePart& part, Rgba8 nothing, const HoleScratch& scratch);

}  // namespace lw
