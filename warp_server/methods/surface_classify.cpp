#include "warp_server/methods/surface_classify.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <future>
#include <utility>

#include "core/colour.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_costs.h"
#include "warp_server/methods/surface_edge_lattice.h"
#include "warp_server/methods/surface_links.h"
#include "warp_server/methods/surface_shares.h"
#include "warp_server/methods/surface_tiles.h"
#include "warp_server/methods/surface_tolerances.h"
#include "warp_server/methods/surface_writer.h"

namespace lw {
namespace {

// Patches grow from single cells to squares of this many cells by powers of two, and those to strips.
constexpr int kLargestPatch = 64;
// Where looking for planes starts: most blocks of this size are one plane in man-made scenes.
constexpr int kFirstBlock = kTileSize;

// Of the largest patches side by side: a region whose source and target are together 220 KiB.
constexpr int kRegionBlocks = 4;
constexpr std::size_t kMostLanes = 16;  // floats in the widest vector

// Cuts the image into the largest blocks that are planes, and into cells where surfaces meet.
class PatchBuilder {
public:
    PatchBuilder(const SurfaceLinks& links, PreparedSurface& out)
        : links_{&links}, out_{&out}, size_px_{links.size_px()}, writer_{links}, tiles_{links, out} {}

    void build() {
        for (int y = 0; y < size_px_.y; y += kLargestPatch) {
            for (int x = 0; x < size_px_.x; x += kLargestPatch) {
                BlockPlane plane;
                if (merge_block(x, y, kLargestPatch, plane)) {
                    extend_strip(x, y, plane);
                } else {
                    add_strip();
                }
                if ((x / kLargestPatch + 1) % kRegionBlocks == 0) end_region();
            }
            add_strip();
            end_region();
        }
        out_->regions.push_back(
            {out_->blocks.size(), out_->patches.size(), out_->tiles.surfaces.size(), out_->edges.size()});
    }

private:
    // Whole vectors, so that none of a list is drawn in parts.
    void end_region() {
        const auto whole = [](std::size_t count) { return count / kMostLanes * kMostLanes; };
        out_->regions.push_back({whole(out_->blocks.size()), whole(out_->patches.size()),
                                 whole(out_->tiles.surfaces.size()), whole(out_->edges.size())});
    }

    // True when the whole block is one plane, which the caller must add; else everything in it has been added.
    bool merge_block(int x, int y, int size, BlockPlane& plane) {
        if (size <= kFirstBlock) return plane_or_parts(x, y, size, plane);
        // Whole first: one look at each pixel of a large plane, and of what is none a look at its first pixels.
        plane = plane_through_corners(x, y, {size, size});
        if (is_plane(x, y, size, plane)) return true;
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
        if (all_whole && children_agree(x, y, half, exists, planes, plane)) return true;
        for (std::size_t i = 0; i < 4; ++i) {
            const int child_x = x + ((i & 1U) != 0 ? half : 0);
            const int child_y = y + ((i & 2U) != 0 ? half : 0);
            if (whole[i]) add_patch(child_x, child_y, half, planes[i]);
        }
        return false;
    }

    // Blocks of the largest size in a row on one plane become one strip: long rows are drawn faster than short ones.
    void extend_strip(int x, int y, const BlockPlane& plane) {
        strip_parts_.push_back(plane);
        const int begin = strip_parts_.size() == 1 ? x : strip_x_;
        const BlockPlane longer = plane_through_corners(begin, y, {x + kLargestPatch - begin, kLargestPatch});
        for (std::size_t i = 0; i < strip_parts_.size(); ++i) {
            if (agrees(strip_parts_[i], longer, begin, y, {static_cast<int>(i) * kLargestPatch, 0}, kLargestPatch))
                continue;
            strip_parts_.pop_back();
            add_strip();
            strip_parts_.push_back(plane);
            break;
        }
        if (strip_parts_.size() == 1) {
            strip_x_ = x;
            strip_y_ = y;
            strip_plane_ = plane;
        } else {
            strip_plane_ = longer;
        }
    }

    void add_strip() {
        if (strip_parts_.empty()) return;
        const int columns = static_cast<int>(strip_parts_.size()) * kLargestPatch;
        writer_.add(out_->blocks, strip_x_, strip_y_, {columns, kLargestPatch}, strip_plane_, kAllCorners);
        strip_parts_.clear();
    }

    [[nodiscard]] BlockPlane plane_through_corners(int x0, int y0, glm::ivec2 size) const {
        const int x1 = std::min(x0 + size.x, size_px_.x - 1);
        const int y1 = std::min(y0 + size.y, size_px_.y - 1);
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
            if (!agrees(planes[i], plane, x, y, {dx, dy}, half)) return false;
        }
        return true;
    }

    // Does the plane of a part, `offset` into the block at (x, y), lie on that of the block?
    [[nodiscard]] bool agrees(const BlockPlane& part, const BlockPlane& plane, int x, int y, glm::ivec2 offset,
                              int size) const {
        if (part.id != plane.id) return false;
        const glm::ivec2 reach = glm::min(glm::ivec2{size}, size_px_ - 1 - glm::ivec2{x, y} - offset);
        const auto agree_at = [&](int dx, int dy) {
            return depths_agree(plane.id, part.at(dx, dy), plane.at(offset.x + dx, offset.y + dy));
        };
        return agree_at(0, 0) && agree_at(reach.x, 0) && agree_at(0, reach.y) && agree_at(reach.x, reach.y);
    }

    bool plane_or_parts(int x, int y, int size, BlockPlane& plane) {
        if (size == 1) {
            writer_.add_cell_surface(out_->patches, x, y, kAllCorners);
            return false;
        }
        plane = plane_through_corners(x, y, {size, size});
        if (is_plane(x, y, size, plane)) return true;
        if (size == kTileSize && !is_all_linked(x, y, size)) {
            tiles_.build(x, y);
            return false;
        }
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
        // It goes through three corners: where it is none, the fourth most often says so.
        const float last = links_->depth_of(plane.id, x + columns - 1, y + rows - 1);
        if (!depths_agree(plane.id, last, plane.at(columns - 1, rows - 1))) return false;
        return block_is_plane(links_->pixels(), {x, y, columns, rows, plane.id, plane.depth, plane.gradient_x,
                                                 plane.gradient_y, links_->tolerance(plane.id, kPlaneDepthPart)});
    }

    [[nodiscard]] bool depths_agree(ObjectId id, float depth, float expected) const {
        return std::abs(depth - expected) <= links_->tolerance(id, kPlaneDepthPart).at(depth);
    }

    // Does no surface meet another in the block?
    [[nodiscard]] bool is_all_linked(int x, int y, int size) const {
        for (int row = y; row < std::min(y + size, size_px_.y); ++row) {
            for (int column = x; column < std::min(x + size, size_px_.x); ++column) {
                if (!joins_all_corners(links_->sides(column, row))) return false;
            }
        }
        return true;
    }

    void add_patch(int x, int y, int size, const BlockPlane& plane) {
        // Apart, because writes of many pixels at once and of single ones hold each other up when they alternate.
        writer_.add(size >= kFirstBlock ? out_->blocks : out_->patches, x, y, {size, size}, plane, kAllCorners);
    }

    const SurfaceLinks* links_;
    PreparedSurface* out_;
    glm::ivec2 size_px_;
    PatchWriter writer_;
    TileBuilder tiles_;
    std::vector<BlockPlane> strip_parts_;  // blocks of the strip so far, from the left
    BlockPlane strip_plane_;
    int strip_x_ = 0;
    int strip_y_ = 0;
};

// What is made of the pixels whatever surfaces they show.
struct Colours {
    LinearImage linear;
    LinearImage quarters;
    int quarter_samples = 1;
    std::vector<IdCount> id_counts;
};

Colours colours_of(const CpuPixels& pixels, SurfaceUse use) {
    Colours colours;
    colours.id_counts = count_ids(pixels);
    if (use != SurfaceUse::cpu_kernels) return colours;
    colours.linear = LinearImage{pixels.colour, pixels.alpha_is_share ? LinearAlpha::kept : LinearAlpha::none};
    const bool has_quarters = pixels.quarters.size_px() == kLatticeSteps * pixels.colour.size_px();
    if (has_quarters) colours.quarters = LinearImage{pixels.quarters};
    colours.quarter_samples = pixels.quarter_samples;
    return colours;
}

void make_lattices(const SurfaceLinks& links, Colours&& colours, PreparedSurface& prepared) {
    prepared.linear = std::move(colours.linear);
    if (colours.quarters.size_px() != glm::ivec2{0}) {
        if (prepared.linear.has_alpha()) {
            QuarterParts parts{links, prepared.linear, colours.quarters};
            make_edge_lattices(parts, prepared);
            parts.join_for_lattice();
        }
        prepared.lattice = ColourLattice{prepared.linear, std::move(colours.quarters), colours.quarter_samples};
    }
    if (prepared.linear.has_alpha()) halve_lacks_of_thin_things(links, prepared.linear);
}

}  // namespace

void PatchList::clear() { *this = {}; }

void PatchList::reserve(std::size_t count) {
    for (std::vector<float>* values : {&x, &y, &depth, &gradient_x, &gradient_y, &left, &right, &top, &bottom}) {
        values->reserve(count);
    }
    object_id.reserve(count);
    corners.reserve(count);
}

std::shared_ptr<const PreparedSurface> classify_surfaces(const CpuPixels& pixels, SurfaceUse use, float unseen_step,
                                                         int threads) {
    auto prepared = std::make_shared<PreparedSurface>();
    prepared->size_px = pixels.depth.size_px();
    // Enough for most pictures; memory that is not written to costs nothing.
    const std::size_t pixel_count = pixels.depth.pixels().size();
    prepared->patches.reserve(pixel_count / 8);
    prepared->edges.reserve(pixel_count / 16);
    prepared->tiles.surfaces.reserve(pixel_count / 32);
    prepared->tiles.cells.reserve(pixel_count / 32 * static_cast<std::size_t>(kTileSize));
    // Where no thread can be had, the colours are made when they are asked for.
    const auto policy = threads > 1 ? std::launch::async | std::launch::deferred : std::launch::deferred;
    std::future<Colours> beside = std::async(policy, colours_of, std::cref(pixels), use);
    const SurfaceLinks links{pixels, unseen_step};
    PatchBuilder{links, *prepared}.build();
    Colours colours = beside.get();
    prepared->id_counts = std::move(colours.id_counts);
    if (use == SurfaceUse::cpu_kernels) make_lattices(links, std::move(colours), *prepared);
    prepared->bounds = bounds_of_regions(*prepared);
    prepared->region_costs = costs_of_regions(*prepared);
    return prepared;
}

}  // namespace lw
