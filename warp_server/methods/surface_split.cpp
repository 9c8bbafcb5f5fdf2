#include "warp_server/methods/surface_split.h"

#include <algorithm>
#include <cmath>

#include "warp_server/methods/surface_tolerances.h"

namespace lw {
namespace {

struct Span {
    float first;
    float last;
};

// Cells [0, cells) cut in the middle, the ends kept as they are.
Span part_of(float low, float high, float middle, bool second, float overlap) {
    return second ? Span{middle - overlap, high} : Span{low, middle + overlap};
}

}  // namespace

void split_patch(const PatchList& list, std::uint32_t index, PatchList& parts) {
    const float columns = std::ceil(list.right[index] - 0.5F);
    const float rows = std::ceil(list.bottom[index] - 0.5F);
    if (columns <= 1.0F && rows <= 1.0F) return;
    const float middle_x = std::floor(columns / 2.0F);
    const float middle_y = std::floor(rows / 2.0F);
    for (const bool lower : {false, true}) {
        if (lower && middle_y == 0.0F) continue;
        for (const bool right : {false, true}) {
            if (right && middle_x == 0.0F) continue;
            const Span x = middle_x == 0.0F
                               ? Span{list.left[index], list.right[index]}
                               : part_of(list.left[index], list.right[index], middle_x, right, kPatchOverlap.after_px);
            const Span y = middle_y == 0.0F
                               ? Span{list.top[index], list.bottom[index]}
                               : part_of(list.top[index], list.bottom[index], middle_y, lower, kPatchOverlap.after_px);
            const float from_x = right ? middle_x : 0.0F;
            const float from_y = lower ? middle_y : 0.0F;
            parts.x.push_back(list.x[index] + from_x);
            parts.y.push_back(list.y[index] + from_y);
            parts.depth.push_back(list.depth[index] + from_x * list.gradient_x[index] +
                                  from_y * list.gradient_y[index]);
            parts.gradient_x.push_back(list.gradient_x[index]);
            parts.gradient_y.push_back(list.gradient_y[index]);
            parts.left.push_back(x.first - from_x);
            parts.right.push_back(x.last - from_x);
            parts.top.push_back(y.first - from_y);
            parts.bottom.push_back(y.last - from_y);
            parts.object_id.push_back(list.object_id[index]);
            parts.corners.push_back(list.corners[index]);
        }
    }
}

void split_tile(const SurfaceTiles& tiles, std::size_t index, PatchList& whole, PatchList& edges) {
    const PatchList& list = tiles.surfaces;
    for (int row = 0; row < kTileSize; ++row) {
        const std::uint32_t cells =
            tiles.cells[index * static_cast<std::size_t>(kTileSize) + static_cast<std::size_t>(row)];
        const auto corners_at = [&](int column) {
            return static_cast<std::uint8_t>(column < kTileSize ? cells >> (4 * column) & kAllCorners : 0);
        };
        int end = 0;
        for (int column = 0; column < kTileSize; column = end) {
            end = column + 1;
            const std::uint8_t corners = corners_at(column);
            if (corners == 0) continue;
            const bool is_whole = corners == kAllCorners;
            while (is_whole && corners_at(end) == kAllCorners) ++end;
            PatchList& parts = is_whole ? whole : edges;
            const PatchOverlap overlap = is_whole ? kPatchOverlap : kEdgeOverlap;
            const auto from_x = static_cast<float>(column);
            const auto from_y = static_cast<float>(row);
            parts.x.push_back(list.x[index] + from_x);
            parts.y.push_back(list.y[index] + from_y);
            parts.depth.push_back(list.depth[index] + from_x * list.gradient_x[index] +
                                  from_y * list.gradient_y[index]);
            parts.gradient_x.push_back(list.gradient_x[index]);
            parts.gradient_y.push_back(list.gradient_y[index]);
            // Cells end as the tile does there: at the rim of the image half a pixel off.
            parts.left.push_back(column > 0 ? -overlap.before_px : (is_whole ? list.left : tiles.edge_left)[index]);
            parts.top.push_back(row > 0 ? -overlap.before_px : (is_whole ? list.top : tiles.edge_top)[index]);
            parts.right.push_back(
                std::min(static_cast<float>(end - column) + overlap.after_px, list.right[index] - from_x));
            parts.bottom.push_back(std::min(1.0F + overlap.after_px, list.bottom[index] - from_y));
            parts.object_id.push_back(list.object_id[index]);
            parts.corners.push_back(corners);
            if (is_whole || tiles.edge_number.empty()) continue;
            const std::size_t in_tiles = index * static_cast<std::size_t>(kTileSize) + static_cast<std::size_t>(row);
            parts.edge_number.push_back(tiles.edge_number[in_tiles] + column);
        }
    }
}

}  // namespace lw
