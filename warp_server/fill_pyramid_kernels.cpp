#include "warp_server/fill_pyramid_kernels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/fill_pyramid_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Depths within these factors count as one surface. Wider inside a cell, whose pixels may lie on a slanted ground.
constexpr float kAllowed = 1.1F;
constexpr float kSameSurface = 1.3F;
// Weight of a cell that the limit forbids: it shows only where there is nothing else.
constexpr float kForbiddenWeight = 1e-4F;

constexpr float limit_of(float stored) { return -1.0F - stored; }
HWY_INLINE bool is_seen(float depth) { return depth >= 0.0F; }

HWY_INLINE FillCell& cell_at(FillLevel& level, int x, int y) {
    return level
        .cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.size.x) + static_cast<std::size_t>(x)];
}

HWY_INLINE const FillCell& cell_at(const FillLevel& level, int x, int y) {
    return level
        .cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.size.x) + static_cast<std::size_t>(x)];
}

using D1 = hn::CappedTag<float, 1>;

// One cell per lane.
template <class D>
struct Cells {
    hn::VFromD<D> red;
    hn::VFromD<D> green;
    hn::VFromD<D> blue;
    hn::VFromD<D> depth;
};

// The cells that these children make: the mean of the farthest of those that the limits of the holes among them allow.
// No fused multiplication, so that every instruction set rounds alike.
template <class D>
HWY_INLINE Cells<D> merged(D d, const Cells<D> (&children)[4]) {
    using V = hn::VFromD<D>;
    const V zero = hn::Zero(d);
    const V one = hn::Set(d, 1.0F);
    const V infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    V limit = hn::Set(d, -1.0F);
    for (const Cells<D>& child : children) {
        const auto is_hole = hn::And(hn::Lt(child.depth, zero), hn::Gt(child.depth, hn::Set(d, kUnknownCell)));
        limit = hn::Max(limit, hn::IfThenElse(is_hole, hn::Sub(hn::Set(d, -1.0F), child.depth), limit));
    }
    const auto has_hole = hn::Ge(limit, zero);
    const V allowed = hn::IfThenElse(has_hole, hn::Mul(limit, hn::Set(d, kAllowed)), infinity);
    V farthest = infinity;
    for (const Cells<D>& child : children) {
        const auto counts = hn::And(hn::Ge(child.depth, zero), hn::Le(child.depth, allowed));
        farthest = hn::Min(farthest, hn::IfThenElse(counts, child.depth, infinity));
    }
    const V nearest = hn::Min(allowed, hn::Mul(farthest, hn::Set(d, kSameSurface)));
    V count = zero;
    Cells<D> sum{zero, zero, zero, zero};
    for (const Cells<D>& child : children) {
        const auto counts = hn::And(hn::Ge(child.depth, zero), hn::Le(child.depth, nearest));
        count = hn::Add(count, hn::IfThenElseZero(counts, one));
        sum.red = hn::Add(sum.red, hn::IfThenElseZero(counts, child.red));
        sum.green = hn::Add(sum.green, hn::IfThenElseZero(counts, child.green));
        sum.blue = hn::Add(sum.blue, hn::IfThenElseZero(counts, child.blue));
        sum.depth = hn::Add(sum.depth, hn::IfThenElseZero(counts, child.depth));
    }
    const auto is_known = hn::Gt(count, zero);
    const V scale = hn::Div(one, hn::Max(count, one));
    const V nothing = hn::IfThenElse(has_hole, hn::Sub(hn::Set(d, -1.0F), limit), hn::Set(d, kUnknownCell));
    return {hn::Mul(sum.red, scale), hn::Mul(sum.green, scale), hn::Mul(sum.blue, scale),
            hn::IfThenElse(is_known, hn::Mul(sum.depth, scale), nothing)};
}

template <class D>
HWY_INLINE Cells<D> loaded(D d, const FillCell* cells) {
    Cells<D> loaded;
    hn::LoadInterleaved4(d, &cells->red, loaded.red, loaded.green, loaded.blue, loaded.depth);
    return loaded;
}

template <class D>
HWY_INLINE void store(D d, const Cells<D>& cells, FillCell* to) {
    hn::StoreInterleaved4(cells.red, cells.green, cells.blue, cells.depth, d, &to->red);
}

// Of the lanes of two vectors in a row those of even or odd place. Single lanes have no such instruction.
template <class D, class V>
HWY_INLINE V even_of(D d, V high, V low) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (hn::MaxLanes(D{}) > 1) return hn::ConcatEven(d, high, low);
#endif
    (void)d;
    (void)high;
    return low;
}

template <class D, class V>
HWY_INLINE V odd_of(D d, V high, V low) {
#if HWY_TARGET != HWY_SCALAR
    if constexpr (hn::MaxLanes(D{}) > 1) return hn::ConcatOdd(d, high, low);
#endif
    (void)d;
    (void)low;
    return high;
}

// Of twice as many cells in a row those of even and of odd place.
template <class D>
HWY_INLINE void load_pairs(D d, const FillCell* cells, Cells<D>& even, Cells<D>& odd) {
    const Cells<D> low = loaded(d, cells);
    const Cells<D> high = loaded(d, cells + hn::Lanes(d));
    even = {even_of(d, high.red, low.red), even_of(d, high.green, low.green), even_of(d, high.blue, low.blue),
            even_of(d, high.depth, low.depth)};
    odd = {odd_of(d, high.red, low.red), odd_of(d, high.green, low.green), odd_of(d, high.blue, low.blue),
           odd_of(d, high.depth, low.depth)};
}

template <class D>
HWY_INLINE Cells<D> squared(D d, hn::VFromD<hn::RebindToUnsigned<D>> colour, hn::VFromD<D> depth) {
    const hn::RebindToUnsigned<D> du;
    const hn::RebindToSigned<D> di;
    const auto square = [&](auto bits) {
        const auto value = hn::ConvertTo(d, hn::BitCast(di, hn::And(bits, hn::Set(du, 255U))));
        return hn::Mul(value, value);
    };
    return {square(colour), square(hn::ShiftRight<8>(colour)), square(hn::ShiftRight<16>(colour)), depth};
}

template <class D>
HWY_INLINE void load_pairs(D d, const Rgba8* colour, const float* depth, Cells<D>& even, Cells<D>& odd) {
    const hn::RebindToUnsigned<D> du;
    hn::VFromD<D> even_depth;
    hn::VFromD<D> odd_depth;
    hn::VFromD<hn::RebindToUnsigned<D>> even_colour;
    hn::VFromD<hn::RebindToUnsigned<D>> odd_colour;
    hn::LoadInterleaved2(d, depth, even_depth, odd_depth);
    hn::LoadInterleaved2(du, reinterpret_cast<const std::uint32_t*>(colour), even_colour, odd_colour);
    even = squared(d, even_colour, even_depth);
    odd = squared(d, odd_colour, odd_depth);
}

// Calls some(d, x) with ever narrower vectors until [begin, end) is covered.
template <class Some>
HWY_INLINE void for_some(int begin, int end, Some some) {
    const hn::ScalableTag<float> d;
    const hn::CappedTag<float, 4> d4;
    const D1 d1;
    int x = begin;
    for (const int lanes = static_cast<int>(hn::Lanes(d)); x + lanes <= end; x += lanes) some(d, x);
    for (const int lanes = static_cast<int>(hn::Lanes(d4)); x + lanes <= end; x += lanes) some(d4, x);
    for (; x < end; ++x) some(d1, x);
}

// Cells [begin, end) of row y of `coarser`; their children all lie in `finer`.
void pull_inner(const FillLevel& finer, int y, int begin, int end, FillLevel& coarser) {
    for_some(begin, end, [&](auto d, int x) {
        Cells<decltype(d)> children[4];
        load_pairs(d, &cell_at(finer, 2 * x, 2 * y), children[0], children[1]);
        load_pairs(d, &cell_at(finer, 2 * x, 2 * y + 1), children[2], children[3]);
        store(d, merged(d, children), &cell_at(coarser, x, y));
    });
}

// Cell (x, y) of `coarser`, some of whose children lie outside of `finer`.
void pull_at_border(const FillLevel& finer, int x, int y, FillLevel& coarser) {
    static constexpr FillCell kOutside{0.0F, 0.0F, 0.0F, kUnknownCell};
    const D1 d;
    Cells<D1> children[4];
    for (int i = 0; i < 4; ++i) {
        const int cx = 2 * x + (i & 1);
        const int cy = 2 * y + (i >> 1);
        children[i] = loaded(d, cx < finer.size.x && cy < finer.size.y ? &cell_at(finer, cx, cy) : &kOutside);
    }
    store(d, merged(d, children), &cell_at(coarser, x, y));
}

void pull_level_here(const FillLevel& finer, FillLevel& coarser) {
    const glm::ivec2 inner = finer.size / 2;
    for (int y = 0; y < coarser.size.y; ++y) {
        const int inner_end = y < inner.y ? inner.x : 0;
        pull_inner(finer, y, 0, inner_end, coarser);
        for (int x = inner_end; x < coarser.size.x; ++x) pull_at_border(finer, x, y, coarser);
    }
}

// Cell (x, y) of level 1, some of whose pixels lie outside of the picture.
void pull_pixels_at_border(const FillPixels& pixels, int x, int y, FillLevel& level1) {
    const D1 d;
    const hn::RebindToUnsigned<D1> du;
    Cells<D1> children[4];
    for (int i = 0; i < 4; ++i) {
        const int px = 2 * x + (i & 1);
        const int py = 2 * y + (i >> 1);
        children[i] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Set(d, kUnknownCell)};
        if (px >= pixels.size_px.x || py >= pixels.size_px.y) continue;
        const auto place =
            static_cast<std::size_t>(py) * static_cast<std::size_t>(pixels.size_px.x) + static_cast<std::size_t>(px);
        const auto* colour = reinterpret_cast<const std::uint32_t*>(pixels.colour + place);
        children[i] = squared(d, hn::LoadU(du, colour), hn::LoadU(d, pixels.depth + place));
    }
    store(d, merged(d, children), &cell_at(level1, x, y));
}

// Cells [begin, end) of row y of level 1.
void pull_pixels(const FillPixels& pixels, int y, int begin, int end, FillLevel& level1) {
    const int inner_end = 2 * y + 1 < pixels.size_px.y ? std::clamp(pixels.size_px.x / 2, begin, end) : begin;
    const auto width = static_cast<std::size_t>(pixels.size_px.x);
    const std::size_t above = static_cast<std::size_t>(2 * y) * width;
    for_some(begin, inner_end, [&](auto d, int x) {
        Cells<decltype(d)> children[4];
        const std::size_t first = above + 2 * static_cast<std::size_t>(x);
        load_pairs(d, pixels.colour + first, pixels.depth + first, children[0], children[1]);
        load_pairs(d, pixels.colour + first + width, pixels.depth + first + width, children[2], children[3]);
        store(d, merged(d, children), &cell_at(level1, x, y));
    });
    for (int x = inner_end; x < end; ++x) pull_pixels_at_border(pixels, x, y, level1);
}

void pull_tiles_here(const FillPixels& pixels, std::span<const FillTileSpan> tiles, std::span<FillLevel> levels) {
    for (const FillTileSpan& span : tiles) {
        for (int y = 4 * span.y; y < 4 * span.y + 4; ++y) {
            pull_pixels(pixels, y, 4 * span.begin, 4 * span.end, levels[1]);
        }
        for (int y = 2 * span.y; y < 2 * span.y + 2; ++y) {
            pull_inner(levels[1], y, 2 * span.begin, 2 * span.end, levels[2]);
        }
        pull_inner(levels[2], span.y, span.begin, span.end, levels[3]);
    }
}

// The four floats of a cell. Multiplied and added apart, so that every instruction set rounds alike.
#if HWY_TARGET == HWY_SCALAR
struct Four {
    std::array<float, 4> parts{};

    template <class Operation>
    HWY_INLINE static Four each(Operation operation) {
        return {{operation(std::size_t{0}), operation(std::size_t{1}), operation(std::size_t{2}),
                 operation(std::size_t{3})}};
    }
    HWY_INLINE static Four of(float value) { return {{value, value, value, value}}; }
    HWY_INLINE static Four of(const FillCell& cell) { return {{cell.red, cell.green, cell.blue, cell.depth}}; }
    HWY_INLINE static Four of(Rgba8 c) {
        return {{static_cast<float>(c.r), static_cast<float>(c.g), static_cast<float>(c.b), static_cast<float>(c.a)}};
    }
    HWY_INLINE Four operator+(const Four& b) const {
        return each([&](std::size_t i) { return parts[i] + b.parts[i]; });
    }
    HWY_INLINE Four operator-(const Four& b) const {
        return each([&](std::size_t i) { return parts[i] - b.parts[i]; });
    }
    HWY_INLINE Four operator*(const Four& b) const {
        return each([&](std::size_t i) { return parts[i] * b.parts[i]; });
    }
    HWY_INLINE Four operator/(const Four& b) const {
        return each([&](std::size_t i) { return parts[i] / b.parts[i]; });
    }
    HWY_INLINE Four root() const {
        return each([&](std::size_t i) { return std::sqrt(parts[i]); });
    }
    // Everywhere the last part.
    HWY_INLINE Four last() const { return of(parts[3]); }
    // `a` where this is at most `most`, else `b`.
    HWY_INLINE Four at_most(const Four& most, const Four& a, const Four& b) const {
        return each([&](std::size_t i) { return parts[i] <= most.parts[i] ? a.parts[i] : b.parts[i]; });
    }
    HWY_INLINE void store(FillCell& cell) const { cell = {parts[0], parts[1], parts[2], parts[3]}; }
    HWY_INLINE Rgba8 truncated() const {
        const auto byte = [](float value) { return static_cast<std::uint8_t>(value); };
        return {byte(parts[0]), byte(parts[1]), byte(parts[2]), 255};
    }
};
#else
struct Four {
    using D = hn::FixedTag<float, 4>;
    hn::VFromD<D> parts;

    HWY_INLINE static Four of(float value) { return {hn::Set(D{}, value)}; }
    HWY_INLINE static Four of(const FillCell& cell) { return {hn::LoadU(D{}, &cell.red)}; }
    HWY_INLINE static Four of(Rgba8 colour) {
        const hn::FixedTag<std::uint8_t, 4> d8;
        return {hn::ConvertTo(D{}, hn::PromoteTo(hn::RebindToSigned<D>{}, hn::LoadU(d8, &colour.r)))};
    }
    HWY_INLINE Four operator+(const Four& b) const { return {hn::Add(parts, b.parts)}; }
    HWY_INLINE Four operator-(const Four& b) const { return {hn::Sub(parts, b.parts)}; }
    HWY_INLINE Four operator*(const Four& b) const { return {hn::Mul(parts, b.parts)}; }
    HWY_INLINE Four operator/(const Four& b) const { return {hn::Div(parts, b.parts)}; }
    HWY_INLINE Four root() const { return {hn::Sqrt(parts)}; }
    HWY_INLINE Four last() const { return {hn::Broadcast<3>(parts)}; }
    HWY_INLINE Four at_most(const Four& most, const Four& a, const Four& b) const {
        return {hn::IfThenElse(hn::Le(parts, most.parts), a.parts, b.parts)};
    }
    HWY_INLINE void store(FillCell& cell) const { hn::StoreU(parts, D{}, &cell.red); }
    HWY_INLINE Rgba8 truncated() const {
        const hn::FixedTag<std::uint8_t, 4> d8;
        const auto bytes = hn::DemoteTo(d8, hn::ConvertTo(hn::RebindToSigned<D>{}, parts));
        // As one word: reading back single bytes would wait for them to be written.
        const std::uint32_t word = hn::GetLane(hn::BitCast(hn::FixedTag<std::uint32_t, 1>{}, bytes));
        return std::bit_cast<Rgba8>(word | std::bit_cast<std::uint32_t>(Rgba8{0, 0, 0, 255}));
    }
};
#endif

// Where along one axis the children of even or odd place read the coarser level.
struct Tap {
    int offset;    // of the first of two cells, from the child's parent
    float second;  // weight of the second cell
};

HWY_INLINE Tap tap_of(int parity, float towards) {
    // The child's centre lies a quarter cell beside its parent's.
    const float place = (parity == 0 ? -0.25F : 0.25F) + towards;
    const int first = place < -1.0F ? -2 : place < 0.0F ? -1 : place < 1.0F ? 0 : 1;
    return {first, place - static_cast<float>(first)};
}

// How the children of one parity read the coarser level: four cells, and the weight of each.
struct Taps {
    glm::ivec2 offset;
    float weights[4];
};

HWY_INLINE Taps taps_of(glm::ivec2 parity, const glm::vec2& towards) {
    const Tap x = tap_of(parity.x, towards.x);
    const Tap y = tap_of(parity.y, towards.y);
    constexpr float kLeast = 1e-6F;  // so that the sum is never 0
    return {{x.offset, y.offset},
            {(1.0F - x.second) * (1.0F - y.second) + kLeast, x.second * (1.0F - y.second) + kLeast,
             (1.0F - x.second) * y.second + kLeast, x.second * y.second + kLeast}};
}

// The value of the hole at (x, y) of the finer level with this limit.
HWY_INLINE Four push_value(const FillLevel& coarser, const Taps& taps, int x, int y, float limit) {
    const int x0 = std::clamp((x >> 1) + taps.offset.x, 0, coarser.size.x - 1);
    const int x1 = std::clamp((x >> 1) + taps.offset.x + 1, 0, coarser.size.x - 1);
    const int y0 = std::clamp((y >> 1) + taps.offset.y, 0, coarser.size.y - 1);
    const int y1 = std::clamp((y >> 1) + taps.offset.y + 1, 0, coarser.size.y - 1);
    const Four cells[4] = {Four::of(cell_at(coarser, x0, y0)), Four::of(cell_at(coarser, x1, y0)),
                           Four::of(cell_at(coarser, x0, y1)), Four::of(cell_at(coarser, x1, y1))};
    const Four allowed = Four::of(limit * kAllowed);
    const auto weight = [&](int i) {
        const Four full = Four::of(taps.weights[i]);
        return cells[i].last().at_most(allowed, full, full * Four::of(kForbiddenWeight));
    };
    const Four weights[4] = {weight(0), weight(1), weight(2), weight(3)};
    const Four sum = (cells[0] * weights[0] + cells[1] * weights[1]) + (cells[2] * weights[2] + cells[3] * weights[3]);
    return sum / ((weights[0] + weights[1]) + (weights[2] + weights[3]));
}

HWY_INLINE void push_one(const FillLevel& coarser, const Taps& taps, int x, int y, FillLevel& finer) {
    FillCell& cell = cell_at(finer, x, y);
    if (is_seen(cell.depth)) return;
    push_value(coarser, taps, x, y, limit_of(cell.depth)).store(cell);
}

void push_cells(const FillLevel& coarser, glm::ivec2 first, glm::ivec2 end, const glm::vec2& towards,
                FillLevel& finer) {
    const Taps taps[2][2] = {{taps_of({0, 0}, towards), taps_of({1, 0}, towards)},
                             {taps_of({0, 1}, towards), taps_of({1, 1}, towards)}};
    for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) push_one(coarser, taps[y & 1][x & 1], x, y, finer);
    }
}

void push_level_here(const FillLevel& coarser, FillLevel& finer) {
    push_cells(coarser, glm::ivec2{0}, finer.size, glm::vec2{0.0F}, finer);
}

void push_tiles_here(const FillLevel& coarser, std::span<const FillTile> tiles, int side, FillLevel& finer) {
    for (const FillTile& tile : tiles) {
        push_cells(coarser, tile.index * side, (tile.index + 1) * side, tile.towards, finer);
    }
}

// The pyramid's value mixed with the colour to continue.
HWY_INLINE Rgba8 mixed(const Four& value, Rgba8 colour) {
    const Four copy = Four::of(colour);
    const Four part = copy.last() * Four::of(1.0F / 255.0F);
    return ((value + part * (copy * copy - value)).root() + Four::of(0.5F)).truncated();
}

void push_pixels_here(const FillLevel& level1, std::span<const FillTileRun> runs, const FillPixels& pixels) {
    for (const FillTileRun& run : runs) {
        const Taps taps[2] = {taps_of({0, run.y & 1}, run.towards), taps_of({1, run.y & 1}, run.towards)};
        const std::size_t row = static_cast<std::size_t>(run.y) * static_cast<std::size_t>(pixels.size_px.x);
        for (int x = run.begin; x < run.end; ++x) {
            const std::size_t i = row + static_cast<std::size_t>(x);
            const Four value = push_value(level1, taps[x & 1], x, run.y, limit_of(pixels.depth[i]));
            pixels.colour[i] = mixed(value, pixels.colour[i]);
            FillCell cell;
            value.store(cell);
            pixels.depth[i] = cell.depth;
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

void pull_tiles(const FillPixels& pixels, std::span<const FillTileSpan> tiles, std::span<FillLevel> levels) {
    HWY_DYNAMIC_DISPATCH(pull_tiles_here)(pixels, tiles, levels);
}

void pull_level(const FillLevel& finer, FillLevel& coarser) { HWY_DYNAMIC_DISPATCH(pull_level_here)(finer, coarser); }

void push_level(const FillLevel& coarser, FillLevel& finer) { HWY_DYNAMIC_DISPATCH(push_level_here)(coarser, finer); }

void push_tiles(const FillLevel& coarser, std::span<const FillTile> tiles, int side, FillLevel& finer) {
    HWY_DYNAMIC_DISPATCH(push_tiles_here)(coarser, tiles, side, finer);
}

void push_pixels(const FillLevel& level1, std::span<const FillTileRun> runs, const FillPixels& pixels) {
    HWY_DYNAMIC_DISPATCH(push_pixels_here)(level1, runs, pixels);
}

}  // namespace lw
#endif
