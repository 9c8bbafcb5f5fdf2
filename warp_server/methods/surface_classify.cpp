#include "warp_server/methods/surface_classify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "core/colour.h"
#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_cells.h"
#include "warp_server/methods/surface_links.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw {
namespace {

// Patches grow from single cells to squares of this many cells by powers of two; larger ones save little.
constexpr int kLargestPatch = 64;
// Where looking for planes starts: most blocks of this size are one plane in man-made scenes.
constexpr int kFirstBlock = 8;

// Depth over a block, at the centre of its first pixel.
struct BlockPlane {
    ObjectId id = 0;
    float depth = 0.0F;
    float gradient_x = 0.0F;
    float gradient_y = 0.0F;

    [[nodiscard]] float at(int dx, int dy) const {
        return depth + static_cast<float>(dx) * gradient_x + static_cast<float>(dy) * gradient_y;
    }
};

bool depths_agree(float depth, float expected) { return std::abs(depth - expected) <= kPlaneDepthPart * depth; }

// Cuts the image into the largest blocks that are planes, and into cells where surfaces meet.
class PatchBuilder {
public:
    PatchBuilder(const SurfaceLinks& links, PreparedSurface& out)
        : links_{&links}, out_{&out}, size_px_{links.size_px()} {}

    void build() {
        for (int y = 0; y < size_px_.y; y += kLargestPatch) {
            for (int x = 0; x < size_px_.x; x += kLargestPatch) {
                BlockPlane plane;
                if (merge_block(x, y, kLargestPatch, plane)) add_patch(x, y, kLargestPatch, plane);
            }
        }
    }

private:
    // True when the whole block is one plane, which the caller must add; else everything in it has been added.
    bool merge_block(int x, int y, int size, BlockPlane& plane) {
        if (size <= kFirstBlock) return plane_or_parts(x, y, size, plane);
        const int half = size / 2;
        std::array<BlockPlane, 4> planes;
        std::array<bool, 4> exists{};
        std::array<bool, 4> whole{};
        bool all_whole = true;
        for (std::size_t i = 0; i < 4; ++i) {
            const int child_x = x + ((i & 1U) != 0 ? half : 0);
            const int child_y = y + ((i & 2U) != 0 ? half : 0);
            exists[i] = child_x < size_px_.x && child_y < size_px_.y;
            if (!exists[i]) continue;
            whole[i] = merge_block(child_x, child_y, half, planes[i]);
            all_whole = all_whole && whole[i];
        }
        plane = plane_through_corners(x, y, size);
        if (all_whole && children_agree(x, y, half, exists, planes, plane)) return true;
        for (std::size_t i = 0; i < 4; ++i) {
            const int child_x = x + ((i & 1U) != 0 ? half : 0);
            const int child_y = y + ((i & 2U) != 0 ? half : 0);
            if (whole[i]) add_patch(child_x, child_y, half, planes[i]);
        }
        return false;
    }

    [[nodiscard]] BlockPlane plane_through_corners(int x0, int y0, int size) const {
        const int x1 = std::min(x0 + size, size_px_.x - 1);
        const int y1 = std::min(y0 + size, size_px_.y - 1);
        BlockPlane plane;
        plane.id = links_->pixels().object_id.at(x0, y0);
        plane.depth = links_->depth_of(plane.id, x0, y0);
        if (x1 > x0)
            plane.gradient_x = (links_->depth_of(plane.id, x1, y0) - plane.depth) / static_cast<float>(x1 - x0);
        if (y1 > y0)
            plane.gradient_y = (links_->depth_of(plane.id, x0, y1) - plane.depth) / static_cast<float>(y1 - y0);
        return plane;
    }

    [[nodiscard]] bool children_agree(int x, int y, int half, const std::array<bool, 4>& exists,
                                      const std::array<BlockPlane, 4>& planes, const BlockPlane& plane) const {
        for (std::size_t i = 0; i < 4; ++i) {
            if (!exists[i]) continue;
            const int dx = (i & 1U) != 0 ? half : 0;
            const int dy = (i & 2U) != 0 ? half : 0;
            if (planes[i].id != plane.id) return false;
            const int reach_x = std::min(half, size_px_.x - 1 - x - dx);
            const int reach_y = std::min(half, size_px_.y - 1 - y - dy);
            const bool agree = depths_agree(planes[i].at(0, 0), plane.at(dx, dy)) &&
                               depths_agree(planes[i].at(reach_x, 0), plane.at(dx + reach_x, dy)) &&
                               depths_agree(planes[i].at(0, reach_y), plane.at(dx, dy + reach_y)) &&
                               depths_agree(planes[i].at(reach_x, reach_y), plane.at(dx + reach_x, dy + reach_y));
            if (!agree) return false;
        }
        return true;
    }

    bool plane_or_parts(int x, int y, int size, BlockPlane& plane) {
        if (size == 1) {
            add_cell(x, y);
            return false;
        }
        plane = plane_through_corners(x, y, size);
        if (is_plane(x, y, size, plane)) return true;
        const int half = size / 2;
        for (const int child_y : {y, y + half}) {
            for (const int child_x : {x, x + half}) {
                if (child_x >= size_px_.x || child_y >= size_px_.y) continue;
                BlockPlane part;
                if (plane_or_parts(child_x, child_y, half, part)) add_patch(child_x, child_y, half, part);
            }
        }
        return false;
    }

    [[nodiscard]] bool is_plane(int x, int y, int size, const BlockPlane& plane) const {
        const int columns = std::min(size, size_px_.x - 1 - x) + 1;
        const int rows = std::min(size, size_px_.y - 1 - y) + 1;
        return block_is_plane(links_->pixels(),
                              {x, y, columns, rows, plane.id, plane.depth, plane.gradient_x, plane.gradient_y});
    }

    void add_cell(int x, int y) {
        if (joins_all_corners(links_->sides(x, y))) {
            add_cell_surface(out_->patches, x, y, kAllCorners);
            return;
        }
        const CornerGroups& groups = corner_groups(links_->all_links(x, y));
        for (int i = 0; i < groups.count; ++i) {
            const std::uint8_t corners = groups.corners[static_cast<std::size_t>(i)];
            add_cell_surface(corners == kAllCorners ? out_->patches : out_->edges, x, y, corners);
        }
    }

    void add_cell_surface(PatchList& list, int x, int y, std::uint8_t corners) {
        CellSurface surface;
        if (!cell_surface(*links_, x, y, corners, surface)) return;
        add(list, x, y, 1, {surface.object_id, surface.depth, surface.gradient_x, surface.gradient_y}, corners);
    }

    void add_patch(int x, int y, int size, const BlockPlane& plane) {
        // Apart, because writes of many pixels at once and of single ones hold each other up when they alternate.
        add(size >= kFirstBlock ? out_->blocks : out_->patches, x, y, size, plane, kAllCorners);
    }

    // Patches at the rim of the image reach half a pixel further, to the image's edge; the last cells half as far.
    void add(PatchList& list, int x, int y, int size, const BlockPlane& plane, std::uint8_t corners) const {
        const float overlap = corners == kAllCorners ? kPatchOverlapPx : kEdgeOverlapPx;
        const int columns = std::min(size, size_px_.x - x);
        const int rows = std::min(size, size_px_.y - y);
        list.x.push_back(static_cast<float>(x));
        list.y.push_back(static_cast<float>(y));
        list.depth.push_back(plane.depth);
        list.gradient_x.push_back(plane.gradient_x);
        list.gradient_y.push_back(plane.gradient_y);
        list.left.push_back(x == 0 ? -0.5F : -overlap);
        list.top.push_back(y == 0 ? -0.5F : -overlap);
        list.right.push_back(static_cast<float>(columns) + (x + columns == size_px_.x ? -0.5F : overlap));
        list.bottom.push_back(static_cast<float>(rows) + (y + rows == size_px_.y ? -0.5F : overlap));
        list.object_id.push_back(plane.id);
        list.corners.push_back(corners);
    }

    const SurfaceLinks* links_;
    PreparedSurface* out_;
    glm::ivec2 size_px_;
};

// Pixels and bad depths by id. Most rows are of one object and have no bad depth.
void count_ids(const CpuPixels& pixels, const SurfaceLinks& links, std::vector<IdCount>& counts) {
    std::vector<IdCount> by_id(1);
    const auto width = static_cast<std::size_t>(pixels.depth.width());
    for (int y = 0; y < pixels.depth.height(); ++y) {
        const std::span<const ObjectId> ids = pixels.object_id.row(y);
        const std::span<const float> depths = pixels.depth.row(y);
        for (std::size_t x = 0; x < width;) {
            // A row equals itself shifted by one pixel when all of it is the same.
            const bool all_same =
                x == 0 && std::memcmp(ids.data(), ids.data() + 1, (width - 1) * sizeof(ObjectId)) == 0;
            std::size_t end = all_same ? width : x + 1;
            while (end < width && ids[end] == ids[x]) ++end;
            if (ids[x] >= by_id.size()) by_id.resize(std::size_t{ids[x]} + 1);
            IdCount& count = by_id[ids[x]];
            count.pixels += end - x;
            if (links.has_bad_depth(y)) {
                count.bad_depths += static_cast<std::uint64_t>(std::count_if(
                    depths.begin() + static_cast<std::ptrdiff_t>(x), depths.begin() + static_cast<std::ptrdiff_t>(end),
                    [](float depth) { return !is_usable_depth(depth); }));
            }
            x = end;
        }
    }
    for (std::size_t id = 0; id < by_id.size(); ++id) {
        if (by_id[id].pixels == 0) continue;
        counts.push_back(by_id[id]);
        counts.back().id = static_cast<ObjectId>(id);
    }
}

// In pixels of a large block; measured. Small patches cost by their number, not by their size.
constexpr float kCostPerPatch = 6.0F;
constexpr float kCostPerEdge = 12.0F;

std::vector<float> accumulated_costs(const PreparedSurface& prepared) {
    std::vector<float> until(static_cast<std::size_t>(prepared.size_px.y) + 1, 0.0F);
    const auto add = [&](const PatchList& list, float per_patch) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const auto begin = static_cast<std::size_t>(list.y[i]);
            const auto end =
                std::min(begin + static_cast<std::size_t>(std::max(1.0F, list.bottom[i])), until.size() - 1);
            const float per_row = list.right[i] + per_patch / static_cast<float>(end - begin);
            for (std::size_t y = begin; y < end; ++y) until[y + 1] += per_row;
        }
    };
    add(prepared.blocks, kCostPerPatch);
    add(prepared.patches, kCostPerPatch);
    add(prepared.edges, kCostPerEdge);
    for (std::size_t y = 1; y < until.size(); ++y) until[y] += until[y - 1];
    return until;
}

}  // namespace

void PatchList::clear() { *this = {}; }

std::shared_ptr<const PreparedSurface> classify_surfaces(const CpuPixels& pixels) {
    auto prepared = std::make_shared<PreparedSurface>();
    prepared->size_px = pixels.depth.size_px();
    const SurfaceLinks links{pixels};
    PatchBuilder{links, *prepared}.build();
    prepared->linear_colours = linearise(pixels.colour);
    count_ids(pixels, links, prepared->id_counts);
    prepared->cost_until = accumulated_costs(*prepared);
    return prepared;
}

}  // namespace lw
