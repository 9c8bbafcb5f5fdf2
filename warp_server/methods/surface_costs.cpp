#include "warp_server/methods/surface_costs.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "warp_server/methods/surface_bounds.h"
#include "warp_server/methods/surface_classify.h"

namespace lw {
namespace {

// Measured by functions' shares of the time with 1000 movers. Pixels of narrow pieces are read one by one.
constexpr float kCostPerPatch = 6.0F;
constexpr float kCostPerTile = 55.0F;
constexpr float kCostPerLonePixel = 3.5F;
constexpr float kCostPerEdgeCell = 9.0F;
constexpr float kNarrowColumns = 8.0F;  // kFewColumnsPx of the kernels

float area_px(const PixelRect& rect) {
    const glm::vec2 size{rect.size_px()};
    return size.x * size.y;
}

float cost_of_patches(const PatchList& list, std::size_t begin, std::size_t end) {
    float cost = 0.0F;
    for (std::size_t i = begin; i < end; ++i) {
        const float per_pixel = list.right[i] < kNarrowColumns ? kCostPerLonePixel : 1.0F;
        cost += kCostPerPatch + per_pixel * list.right[i] * list.bottom[i];
    }
    return cost;
}

// Of eight numbers of four bits.
std::uint32_t sum_of_nibbles(std::uint32_t nibbles) {
    const std::uint32_t pairs = (nibbles & 0x0F0F0F0FU) + (nibbles >> 4U & 0x0F0F0F0FU);
    return (pairs * 0x01010101U) >> 24U;
}

float cost_of_tile(const SurfaceTiles& tiles, std::size_t tile) {
    constexpr std::uint32_t kFirstOfFour = 0x11111111;
    std::uint32_t whole = 0;  // cells by column, at most eight in each: they fit its four bits
    std::uint32_t any = 0;
    for (std::size_t row = 0; row < std::size_t{kTileSize}; ++row) {
        const std::uint32_t cells = tiles.cells[tile * std::size_t{kTileSize} + row];
        whole += cells & cells >> 1U & cells >> 2U & cells >> 3U & kFirstOfFour;
        any += (cells | cells >> 1U | cells >> 2U | cells >> 3U) & kFirstOfFour;
    }
    const std::uint32_t whole_cells = sum_of_nibbles(whole);
    return kCostPerTile + kCostPerLonePixel * static_cast<float>(whole_cells) +
           kCostPerEdgeCell * static_cast<float>(sum_of_nibbles(any) - whole_cells);
}

}  // namespace

std::vector<float> costs_of_regions(const PreparedSurface& prepared) {
    std::vector<float> costs;
    costs.reserve(prepared.regions.size());
    SurfaceRegion begin;
    for (const SurfaceRegion& end : prepared.regions) {
        float cost = cost_of_patches(prepared.blocks, begin.blocks, end.blocks) +
                     cost_of_patches(prepared.patches, begin.patches, end.patches) +
                     (kCostPerPatch + kCostPerEdgeCell) * static_cast<float>(end.edges - begin.edges);
        for (std::size_t i = begin.tiles; i < end.tiles; ++i) cost += cost_of_tile(prepared.tiles, i);
        costs.push_back(cost);
        begin = end;
    }
    return costs;
}

void add_costs(const PreparedSurface& prepared, const PixelMatrix& target_from_source, glm::ivec2 target_size_px,
               RowCosts& costs) {
    const PixelRect picture{{0, 0}, target_size_px};
    for (std::size_t i = 0; i < prepared.regions.size(); ++i) {
        RegionBounds bounds = prepared.bounds[i];
        if (bounds.empty) continue;
        bounds.static_only = true;
        const std::optional<RegionReach> reach = reach_of(bounds, target_from_source);
        const PixelRect rect = reach ? reach->rect : picture;
        const PixelRect here = common(rect, picture);
        if (here.empty()) continue;
        const float share_here = area_px(here) / area_px(rect);
        costs.add({here.first_px.y, here.end_px.y}, share_here * prepared.region_costs[i]);
    }
}

}  // namespace lw
