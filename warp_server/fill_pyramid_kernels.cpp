#include "warp_server/fill_pyramid_kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/fill_pyramid_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

// Cells are four floats. Plain loops over them, which compilers turn into one instruction of the target's, so that no
// target needs four lanes.

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// Depths within these factors count as one surface. Wider inside a cell, whose pixels may lie on a slanted ground.
constexpr float kAllowed = 1.1F;
constexpr float kSameSurface = 1.3F;
// Weight of a cell that the limit forbids: it shows only where there is nothing else.
constexpr float kForbiddenWeight = 1e-4F;

struct V4 {
    float v[4] = {};
};

HWY_INLINE void add_weighted(V4& sum, const V4& value, float weight) {
    for (int i = 0; i < 4; ++i) sum.v[i] += value.v[i] * weight;
}

HWY_INLINE V4 values_of(const FillCell& cell) { return {{cell.red, cell.green, cell.blue, cell.depth}}; }
HWY_INLINE FillCell cell_from(const V4& value) { return {value.v[0], value.v[1], value.v[2], value.v[3]}; }

constexpr float limit_of(float stored) { return -1.0F - stored; }

HWY_INLINE bool is_seen(float depth) { return depth >= 0.0F; }
HWY_INLINE bool is_unknown(float depth) { return depth <= kUnknownCell; }

// Which of four children a cell is made of.
struct Choice {
    std::array<float, 4> weights;
    float hole_depth;  // where all weights are 0: what the cell stores
};

HWY_INLINE Choice choose(const std::array<float, 4>& depths) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    float limit = -1.0F;
    for (const float depth : depths) {
        if (!is_seen(depth) && !is_unknown(depth)) limit = std::max(limit, limit_of(depth));
    }
    const bool has_hole = limit >= 0.0F;
    const float allowed = has_hole ? limit * kAllowed : kInfinity;
    float farthest = kInfinity;
    for (const float depth : depths) {
        if (is_seen(depth) && depth <= allowed) farthest = std::min(farthest, depth);
    }
    Choice choice{{}, has_hole ? hole_with_limit(limit) : kUnknownCell};
    const float same = farthest * kSameSurface;
    float count = 0.0F;
    for (std::size_t i = 0; i < 4; ++i) {
        const bool counts = is_seen(depths[i]) && depths[i] <= std::min(allowed, same);
        choice.weights[i] = counts ? 1.0F : 0.0F;
        count += choice.weights[i];
    }
    if (count > 0.0F) {
        for (float& weight : choice.weights) weight /= count;
    }
    return choice;
}

HWY_INLINE bool is_empty(const Choice& choice) {
    return choice.weights[0] + choice.weights[1] + choice.weights[2] + choice.weights[3] == 0.0F;
}

HWY_INLINE void pull_cell(const FillCell* const children[4], FillCell& cell) {
    const Choice choice = choose({children[0]->depth, children[1]->depth, children[2]->depth, children[3]->depth});
    if (is_empty(choice)) {
        cell = {0.0F, 0.0F, 0.0F, choice.hole_depth};
        return;
    }
    V4 sum;
    for (std::size_t i = 0; i < 4; ++i) {
        if (choice.weights[i] != 0.0F) add_weighted(sum, values_of(*children[i]), choice.weights[i]);
    }
    cell = cell_from(sum);
}

// Squared colour and depth of a pixel as one vector.
HWY_INLINE V4 squared(const Rgba8& colour, float depth) {
    const auto square = [](std::uint8_t value) {
        const auto f = static_cast<float>(value);
        return f * f;
    };
    return {{square(colour.r), square(colour.g), square(colour.b), depth}};
}

HWY_INLINE void pull_pixel_cell(const FillPixels& pixels, int x, int y, FillCell& cell) {
    std::array<float, 4> depths{};
    std::array<std::size_t, 4> places{};
    for (int i = 0; i < 4; ++i) {
        const int px = x + (i & 1);
        const int py = y + (i >> 1);
        const bool inside = px < pixels.size_px.x && py < pixels.size_px.y;
        const auto place = static_cast<std::size_t>(i);
        places[place] = inside ? static_cast<std::size_t>(py) * static_cast<std::size_t>(pixels.size_px.x) +
                                     static_cast<std::size_t>(px)
                               : 0;
        depths[place] = inside ? pixels.depth[places[place]] : kUnknownCell;
    }
    const Choice choice = choose(depths);
    if (is_empty(choice)) {
        cell = {0.0F, 0.0F, 0.0F, choice.hole_depth};
        return;
    }
    V4 sum;
    for (std::size_t i = 0; i < 4; ++i) {
        if (choice.weights[i] == 0.0F) continue;
        add_weighted(sum, squared(pixels.colour[places[i]], depths[i]), choice.weights[i]);
    }
    cell = cell_from(sum);
}

HWY_INLINE FillCell& cell_at(FillLevel& level, int x, int y) {
    return level
        .cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.size.x) + static_cast<std::size_t>(x)];
}

HWY_INLINE const FillCell& cell_at(const FillLevel& level, int x, int y) {
    return level
        .cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.size.x) + static_cast<std::size_t>(x)];
}

// Cell (x, y) of `coarser`; children outside of the picture are unknown.
void pull_one(const FillLevel& finer, int x, int y, FillLevel& coarser) {
    static constexpr FillCell kOutside{0.0F, 0.0F, 0.0F, kUnknownCell};
    const FillCell* children[4];
    for (int i = 0; i < 4; ++i) {
        const int cx = 2 * x + (i & 1);
        const int cy = 2 * y + (i >> 1);
        children[i] = cx < finer.size.x && cy < finer.size.y ? &cell_at(finer, cx, cy) : &kOutside;
    }
    pull_cell(children, cell_at(coarser, x, y));
}

void pull_tiles_here(const FillPixels& pixels, std::span<const FillTile> tiles, std::span<FillLevel> levels) {
    for (const FillTile& tile : tiles) {
        const glm::ivec2 first = tile.index * (kFillTile_px / 2);
        for (int y = first.y; y < first.y + 4; ++y) {
            for (int x = first.x; x < first.x + 4; ++x) {
                pull_pixel_cell(pixels, 2 * x, 2 * y, cell_at(levels[1], x, y));
            }
        }
        for (int y = 2 * tile.index.y; y < 2 * tile.index.y + 2; ++y) {
            for (int x = 2 * tile.index.x; x < 2 * tile.index.x + 2; ++x) pull_one(levels[1], x, y, levels[2]);
        }
        pull_one(levels[2], tile.index.x, tile.index.y, levels[3]);
    }
}

void pull_level_here(const FillLevel& finer, FillLevel& coarser) {
    for (int y = 0; y < coarser.size.y; ++y) {
        for (int x = 0; x < coarser.size.x; ++x) pull_one(finer, x, y, coarser);
    }
}

// Where along one axis the children of even or odd place read the coarser level.
struct Tap {
    int offset;    // of the first of two cells, from the child's parent
    float second;  // weight of the second cell
};

HWY_INLINE Tap tap_of(int parity, float towards) {
    // The child's centre lies a quarter cell beside its parent's.
    const float place = (parity == 0 ? -0.25F : 0.25F) + towards;
    const float first = std::floor(place);
    return {static_cast<int>(first), place - first};
}

struct Taps {
    std::array<Tap, 2> x;  // by parity
    std::array<Tap, 2> y;
};

HWY_INLINE Taps taps_of(const glm::vec2& towards) {
    return {{tap_of(0, towards.x), tap_of(1, towards.x)}, {tap_of(0, towards.y), tap_of(1, towards.y)}};
}

// The value of the hole at (x, y) of the finer level with this limit.
HWY_INLINE V4 push_value(const FillLevel& coarser, const Taps& taps, int x, int y, float limit) {
    const Tap tx = taps.x[static_cast<std::size_t>(x & 1)];
    const Tap ty = taps.y[static_cast<std::size_t>(y & 1)];
    const int x0 = std::clamp((x >> 1) + tx.offset, 0, coarser.size.x - 1);
    const int x1 = std::clamp((x >> 1) + tx.offset + 1, 0, coarser.size.x - 1);
    const int y0 = std::clamp((y >> 1) + ty.offset, 0, coarser.size.y - 1);
    const int y1 = std::clamp((y >> 1) + ty.offset + 1, 0, coarser.size.y - 1);
    const FillCell* cells[4] = {&cell_at(coarser, x0, y0), &cell_at(coarser, x1, y0), &cell_at(coarser, x0, y1),
                                &cell_at(coarser, x1, y1)};
    const float bilinear[4] = {(1.0F - tx.second) * (1.0F - ty.second), tx.second * (1.0F - ty.second),
                               (1.0F - tx.second) * ty.second, tx.second * ty.second};
    const float allowed = limit * kAllowed;
    V4 sum;
    float weights = 0.0F;
    for (int i = 0; i < 4; ++i) {
        const float weight = (bilinear[i] + 1e-6F) * (cells[i]->depth <= allowed ? 1.0F : kForbiddenWeight);
        add_weighted(sum, values_of(*cells[i]), weight);
        weights += weight;
    }
    const float scale = 1.0F / weights;
    for (float& part : sum.v) part *= scale;
    return sum;
}

HWY_INLINE void push_one(const FillLevel& coarser, const Taps& taps, int x, int y, FillLevel& finer) {
    FillCell& cell = cell_at(finer, x, y);
    if (is_seen(cell.depth)) return;
    cell = cell_from(push_value(coarser, taps, x, y, limit_of(cell.depth)));
}

void push_level_here(const FillLevel& coarser, FillLevel& finer) {
    const Taps taps = taps_of(glm::vec2{0.0F});
    for (int y = 0; y < finer.size.y; ++y) {
        for (int x = 0; x < finer.size.x; ++x) push_one(coarser, taps, x, y, finer);
    }
}

void push_tiles_here(const FillLevel& coarser, std::span<const FillTile> tiles, int side, FillLevel& finer) {
    for (const FillTile& tile : tiles) {
        const Taps taps = taps_of(tile.towards);
        const glm::ivec2 first = tile.index * side;
        for (int y = first.y; y < first.y + side; ++y) {
            for (int x = first.x; x < first.x + side; ++x) push_one(coarser, taps, x, y, finer);
        }
    }
}

HWY_INLINE void store_pixel(const V4& value, Rgba8& colour, float& depth) {
    const auto root = [](float squared) { return static_cast<std::uint8_t>(std::sqrt(squared) + 0.5F); };
    const float copied = static_cast<float>(colour.a) * (1.0F / 255.0F);
    V4 mixed = squared(colour, depth);
    for (int i = 0; i < 3; ++i) mixed.v[i] = value.v[i] + copied * (mixed.v[i] - value.v[i]);
    colour = {root(mixed.v[0]), root(mixed.v[1]), root(mixed.v[2]), 255};
    depth = value.v[3];
}

void push_pixels_here(const FillLevel& level1, std::span<const FillTile> tiles, const FillPixels& pixels) {
    for (const FillTile& tile : tiles) {
        const Taps taps = taps_of(tile.towards);
        const glm::ivec2 first = tile.index * kFillTile_px;
        const glm::ivec2 end = glm::min(first + kFillTile_px, pixels.size_px);
        for (int y = first.y; y < end.y; ++y) {
            for (int x = first.x; x < end.x; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(pixels.size_px.x) +
                                      static_cast<std::size_t>(x);
                if (is_seen(pixels.depth[i])) continue;
                const V4 value = push_value(level1, taps, x, y, limit_of(pixels.depth[i]));
                store_pixel(value, pixels.colour[i], pixels.depth[i]);
            }
        }
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(pull_tiles_here);
HWY_EXPORT(pull_level_here);
HWY_EXPORT(push_level_here);
HWY_EXPORT(push_tiles_here);
HWY_EXPORT(push_pixels_here);

void pull_tiles(const FillPixels& pixels, std::span<const FillTile> tiles, std::span<FillLevel> levels) {
    HWY_DYNAMIC_DISPATCH(pull_tiles_here)(pixels, tiles, levels);
}

void pull_level(const FillLevel& finer, FillLevel& coarser) { HWY_DYNAMIC_DISPATCH(pull_level_here)(finer, coarser); }

void push_level(const FillLevel& coarser, FillLevel& finer) { HWY_DYNAMIC_DISPATCH(push_level_here)(coarser, finer); }

void push_tiles(const FillLevel& coarser, std::span<const FillTile> tiles, int side, FillLevel& finer) {
    HWY_DYNAMIC_DISPATCH(push_tiles_here)(coarser, tiles, side, finer);
}

void push_pixels(const FillLevel& level1, std::span<const FillTile> tiles, const FillPixels& pixels) {
    HWY_DYNAMIC_DISPATCH(push_pixels_here)(level1, tiles, pixels);
}

}  // namespace lw
#endif
