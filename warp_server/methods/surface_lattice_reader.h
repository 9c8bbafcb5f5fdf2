/// Reading colours between the nodes of a ColourLattice.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#undef LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_lattice.h"
#include "warp_server/methods/surface_sampling.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Reads between nodes by a cubic (Catmull and Rom) down and then across, which never leaves the two nodes it lies
/// between: it follows a curve where a straight line would cut it off, and adds no ripples beside an edge. In exact
/// pixels of the source, fraction 0, it is the node, bit for bit.
///
/// Rows pixel by pixel, since four nodes of one are a vector wherever they lie; columns of many pixels at once.
class LatticeReader {
public:
    /// `lattice` outlives this.
    explicit LatticeReader(const ColourLattice& lattice) : lattice_{&lattice} {}

    /// Asks for what a read at x, y touches, in pixels from the centre of the first one; any values.
    HWY_INLINE void prefetch(float x_px, float y_px) const {
        const bool inside = x_px >= 0.0F && y_px >= 0.0F &&
                            x_px * kLatticeSteps < static_cast<float>(lattice_->size().x) &&
                            y_px * kLatticeSteps < static_cast<float>(lattice_->size().y);
        if (!inside) return;
        const std::uint16_t* nodes =
            lattice_->before(static_cast<int>(x_px * kLatticeSteps), static_cast<int>(y_px * kLatticeSteps));
        for (std::ptrdiff_t line = 0; line < ColourLattice::kReadNodes; ++line) {
            __builtin_prefetch(nodes + line * lattice_->row_stride());
        }
    }

    /// Asks for what the next row of target pixels reads that a vector of taps does not, which begins at this node: of
    /// pixels as large as the source's. Asking for all of this row's too took as long, for the first two of four
    /// longer.
    HWY_INLINE void prefetch_below(int column, int row) const {
        const std::uint16_t* nodes = lattice_->before(column, row + ColourLattice::kReadNodes);
        constexpr std::size_t kLine = 64 / sizeof(std::uint16_t);
        for (int line = 0; line < kLatticeSteps; ++line, nodes += lattice_->row_stride()) {
            for (std::size_t at = 0; at <= kLatticeSteps * kChannels * hn::Lanes(DF{}); at += kLine) {
                __builtin_prefetch(nodes + at);
            }
        }
    }

    /// Colours at the taps, nodes and fractions, of the lanes whose bits are in `wanted`, and anything at the others.
    [[nodiscard]] HWY_NOINLINE LinearColours read(const Taps& taps, std::uint32_t wanted) const {
        HWY_ALIGN std::int32_t first[kMaxLanes];
        const auto stride = hn::Set(DI{}, static_cast<std::int32_t>(lattice_->row_stride()));
        const auto column = hn::Mul(taps.x, hn::Set(DI{}, ColourLattice::kChannels));
        hn::Store(hn::Add(hn::Mul(taps.y, stride), column), DI{}, first);
        const LaneWeights down{taps.fy};
        HWY_ALIGN std::int16_t columns[kMaxLanes * kColumns];
        for (std::uint32_t others = ~wanted & ((1U << hn::Lanes(DU{})) - 1U); others != 0; others &= others - 1) {
            std::fill_n(columns + kColumns * static_cast<std::size_t>(__builtin_ctz(others)), kColumns,
                        std::int16_t{0});
        }
        for (; wanted != 0; wanted &= wanted - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(wanted));
            mix_rows(lattice_->before(0, 0) + first[lane], down, lane, columns + kColumns * lane);
        }
        HWY_ALIGN std::uint16_t colours[kMaxLanes * kPixel];
        mix_columns(columns, LaneWeights{taps.fx}, colours);
        const hn::Rebind<std::uint16_t, DU> d16;
        hn::VFromD<decltype(d16)> red;
        hn::VFromD<decltype(d16)> green;
        hn::VFromD<decltype(d16)> blue;
        hn::VFromD<decltype(d16)> unused;
        hn::LoadInterleaved4(d16, colours, red, green, blue, unused);
        return {hn::PromoteTo(DU{}, red), hn::PromoteTo(DU{}, green), hn::PromoteTo(DU{}, blue)};
    }

private:
    static constexpr std::ptrdiff_t kChannels = ColourLattice::kChannels;
    static constexpr std::size_t kPixel = 4;  // values: red, green, blue, and one that nobody asks for
    static constexpr std::size_t kColumns = kPixel * ColourLattice::kReadNodes;

    // Of every lane, in 15 bits and twice side by side: between b and c of four values a, b, c, d lies
    //   b + step (c - b) + before (b - a) - after (d - c),
    // where of the fraction f step = f - before + after, before = f (1 - f)^2 / 2, and after = f^2 (1 - f) / 2. Cut
    // off, so that step stays below 1.
    struct LaneWeights {
        explicit LaneWeights(hn::VFromD<DI> fraction15) {
            const VF fraction = hn::Mul(hn::ConvertTo(DF{}, fraction15), hn::Set(DF{}, 1.0F / 32768.0F));
            const VF left = hn::Sub(hn::Set(DF{}, 1.0F), fraction);
            const VF half = hn::Mul(hn::Mul(fraction, left), hn::Set(DF{}, 16384.0F));
            const auto before15 = truncated(hn::Mul(half, left));
            const auto after15 = truncated(hn::Mul(half, fraction));
            keep(before15, before);
            keep(after15, after);
            keep(hn::Add(hn::Sub(fraction15, before15), after15), step);
        }

        HWY_ALIGN std::uint32_t step[kMaxLanes];
        HWY_ALIGN std::uint32_t before[kMaxLanes];
        HWY_ALIGN std::uint32_t after[kMaxLanes];

    private:
        static HWY_INLINE void keep(hn::VFromD<DI> weight, std::uint32_t* to) {
            hn::Store(hn::BitCast(DU{}, hn::Or(weight, hn::ShiftLeft<16>(weight))), DU{}, to);
        }
    };

    template <class V>
    struct Weights {
        V step;
        V before;
        V after;
    };

    template <class V>
    [[nodiscard]] static HWY_INLINE V between(V a, V b, V c, V d, const Weights<V>& weights) {
        const V step = hn::MulFixedPoint15(hn::Sub(c, b), weights.step);
        const V bend = hn::Sub(hn::MulFixedPoint15(hn::Sub(b, a), weights.before),
                               hn::MulFixedPoint15(hn::Sub(d, c), weights.after));
        const V value = hn::SaturatedAdd(b, hn::SaturatedAdd(step, bend));
        return hn::Min(hn::Max(value, hn::Min(b, c)), hn::Max(b, c));
    }

#if HWY_TARGET == HWY_SCALAR
    using One = hn::CappedTag<std::int16_t, 1>;

    [[nodiscard]] static Weights<hn::Vec<One>> weights_at(const LaneWeights& all, std::size_t lane) {
        const auto one = [](std::uint32_t pair) { return hn::Set(One{}, static_cast<std::int16_t>(pair & 0x7FFFU)); };
        return {one(all.step[lane]), one(all.before[lane]), one(all.after[lane])};
    }

    void mix_rows(const std::uint16_t* nodes, const LaneWeights& down, std::size_t lane, std::int16_t* columns) const {
        const auto weights = weights_at(down, lane);
        for (std::ptrdiff_t i = 0; i < kChannels * ColourLattice::kReadNodes; ++i) {
            const auto value = [&](std::ptrdiff_t row) {
                return hn::Set(One{}, static_cast<std::int16_t>(nodes[row * lattice_->row_stride() + i]));
            };
            const std::ptrdiff_t column = i / kChannels;
            hn::Store(between(value(0), value(1), value(2), value(3), weights), One{},
                      columns + column * static_cast<std::ptrdiff_t>(kPixel) + i % kChannels);
        }
    }

    static void mix_columns(const std::int16_t* columns, const LaneWeights& across, std::uint16_t* colours) {
        const auto weights = weights_at(across, 0);
        for (std::size_t i = 0; i < kPixel; ++i) {
            const auto value = [&](std::size_t column) { return hn::Load(One{}, columns + column * kPixel + i); };
            const auto mixed = between(value(0), value(1), value(2), value(3), weights);
            colours[i] = static_cast<std::uint16_t>(hn::GetLane(mixed));
        }
    }
#else
    // Of the four nodes in four rows the four columns, kPixel values each.
    HWY_INLINE void mix_rows(const std::uint16_t* nodes, const LaneWeights& down, std::size_t lane,
                             std::int16_t* columns) const {
        const hn::CappedTag<std::int16_t, kColumns> d;
        const hn::RepartitionToWide<hn::RebindToUnsigned<decltype(d)>> pairs;
        const auto all = [&](std::uint32_t pair) LW_INLINE_LAMBDA { return hn::BitCast(d, hn::Set(pairs, pair)); };
        const Weights<hn::Vec<decltype(d)>> weights{all(down.step[lane]), all(down.before[lane]),
                                                    all(down.after[lane])};
        const std::ptrdiff_t stride = lattice_->row_stride();
        for (std::size_t column = 0; column < ColourLattice::kReadNodes; column += hn::Lanes(d) / kPixel) {
            const auto* first = reinterpret_cast<const std::int16_t*>(nodes) + kChannels * column;
            const auto row = [&](std::ptrdiff_t index)
                                 LW_INLINE_LAMBDA { return hn::LoadU(d, first + index * stride); };
            const auto mixed = between(row(0), row(1), row(2), row(3), weights);
            hn::Store(spread(d, mixed), d, columns + kPixel * column);
        }
    }

    // Three values of each node become four.
    template <class D>
    [[nodiscard]] static HWY_INLINE hn::Vec<D> spread(D d, hn::Vec<D> nodes) {
        constexpr auto kUnused = std::int8_t{-1};
        HWY_ALIGN static constexpr std::int8_t kBytes[16] = {0, 1, 2, 3, 4,  5,  kUnused, kUnused,
                                                             6, 7, 8, 9, 10, 11, kUnused, kUnused};
        const hn::Repartition<std::int8_t, D> d8;
        if constexpr (hn::MaxLanes(d) == 16) {
            // Two nodes, which are three pairs, into each half.
            HWY_ALIGN static constexpr std::int32_t kPairs[8] = {0, 1, 2, 0, 3, 4, 5, 0};
            const hn::RepartitionToWide<D> pairs;
            const auto halves = hn::TableLookupLanes(hn::BitCast(pairs, nodes), hn::SetTableIndices(pairs, kPairs));
            return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(d8, halves), hn::LoadDup128(d8, kBytes)));
        } else {
            return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(d8, nodes), hn::LoadDup128(d8, kBytes)));
        }
    }

    // Many pixels at once: one 64-bit lane is one node.
    static HWY_INLINE void mix_columns(const std::int16_t* columns, const LaneWeights& across, std::uint16_t* colours) {
        const hn::Repartition<std::uint64_t, DU> nodes;
        const hn::Repartition<std::int16_t, DU> d;
        const hn::Rebind<std::uint32_t, decltype(nodes)> half;
        using V = hn::Vec<decltype(d)>;
        for (std::size_t lane = 0; lane < hn::Lanes(DU{}); lane += hn::Lanes(nodes)) {
            const auto each = [&](const std::uint32_t* pairs) LW_INLINE_LAMBDA {
                const auto low = hn::PromoteTo(nodes, hn::Load(half, pairs + lane));
                return hn::BitCast(d, hn::Or(low, hn::ShiftLeft<32>(low)));
            };
            hn::Vec<decltype(nodes)> a;
            hn::Vec<decltype(nodes)> b;
            hn::Vec<decltype(nodes)> c;
            hn::Vec<decltype(nodes)> e;
            hn::LoadInterleaved4(nodes, reinterpret_cast<const std::uint64_t*>(columns + kColumns * lane), a, b, c, e);
            const auto values = [&](hn::Vec<decltype(nodes)> node) LW_INLINE_LAMBDA { return hn::BitCast(d, node); };
            const Weights<V> weights{each(across.step), each(across.before), each(across.after)};
            const V mixed = between(values(a), values(b), values(c), values(e), weights);
            hn::Store(mixed, d, reinterpret_cast<std::int16_t*>(colours) + kPixel * lane);
        }
    }
#endif

    const ColourLattice* lattice_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
