#include "warp_server/methods/surface_writer.h"

#include <algorithm>

#include "warp_server/methods/surface_cells.h"

namespace lw {

void PatchWriter::add(PatchList& list, int x, int y, glm::ivec2 size, const BlockPlane& plane,
                      std::uint8_t corners) const {
    const PatchOverlap overlap = corners == kAllCorners ? kPatchOverlap : kEdgeOverlap;
    const PatchExtent columns = patch_extent(x, 0, std::min(size.x, size_px_.x - x), size_px_.x, overlap);
    const PatchExtent rows = patch_extent(y, 0, std::min(size.y, size_px_.y - y), size_px_.y, overlap);
    list.x.push_back(static_cast<float>(x));
    list.y.push_back(static_cast<float>(y));
    list.depth.push_back(plane.depth);
    list.gradient_x.push_back(plane.gradient_x);
    list.gradient_y.push_back(plane.gradient_y);
    list.left.push_back(columns.begin);
    list.right.push_back(columns.end);
    list.top.push_back(rows.begin);
    list.bottom.push_back(rows.end);
    list.object_id.push_back(plane.id);
    list.corners.push_back(corners);
}

void PatchWriter::add_cell_surface(PatchList& list, int x, int y, std::uint8_t corners) const {
    CellSurface surface;
    if (!cell_surface(*links_, x, y, corners, surface)) return;
    add(list, x, y, {1, 1}, {surface.object_id, surface.depth, surface.gradient_x, surface.gradient_y}, corners);
}

}  // namespace lw
