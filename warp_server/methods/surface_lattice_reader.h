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

/// Two ways to mix neighbours along a line, in 15 bits. At fraction 0 both are the node before, bit for bit.

/// Of b and c: b + f (c - b).
struct StraightMix {
    static constexpr std::size_t kNodes = 2;
    static constexpr std::size_t kWeights = 1;

    /// Calls `keep` with each weight.
    template <class Keep>
    static HWY_INLINE void weigh(hn::VFromD<DI> fraction15, const Keep& keep) {
        keep(0, fraction15);
    }

    template <class V>
    [[nodiscard]] static HWY_INLINE V mixed(const V* nodes, const V* weights) {
        return hn::Add(nodes[0], hn::MulFixedPoint15(hn::Sub(nodes[1], nodes[0]), weights[0]));
    }
};

/// Of a, b, c and d the cubic of Catmull and Rom between b and c, which never leaves the two: it follows a curve where
/// a straight line would cut it off, and adds no ripples beside an edge. Without that limit FLIP in the city was 3 %
/// more.
///   b + step (c - b) + before (b - a) - after (d - c),
/// with step = f - before + after, before = f (1 - f)^2 / 2, and after = f^2 (1 - f) / 2, cut off so that step is
/// below 1.
struct CubicMix {
    static constexpr std::size_t kNodes = 4;
    static constexpr std::size_t kWeights = 3;

    template <class Keep>
    static HWY_INLINE void weigh(hn::VFromD<DI> fraction15, const Keep& keep) {
        const VF fraction = hn::Mul(hn::ConvertTo(DF{}, fraction15), hn::Set(DF{}, 1.0F / 32768.0F));
        const VF left = hn::Sub(hn::Set(DF{}, 1.0F), fraction);
        const VF half = hn::Mul(hn::Mul(fraction, left), hn::Set(DF{}, 16384.0F));
        const auto before = truncated(hn::Mul(half, left));
        const auto after = truncated(hn::Mul(half, fraction));
        keep(0, hn::Add(hn::Sub(fraction15, before), after));
        keep(1, before);
        keep(2, after);
    }

    template <class V>
    [[nodiscard]] static HWY_INLINE V mixed(const V* nodes, const V* weights) {
        const V a = nodes[0];
        const V b = nodes[1];
        const V c = nodes[2];
        const V d = nodes[3];
        const V step = hn::MulFixedPoint15(hn::Sub(c, b), weights[0]);
        const V bend =
            hn::Sub(hn::MulFixedPoint15(hn::Sub(b, a), weights[1]), hn::MulFixedPoint15(hn::Sub(d, c), weights[2]));
        const V value = hn::SaturatedAdd(b, hn::SaturatedAdd(step, bend));
        return hn::Min(hn::Max(value, hn::Min(b, c)), hn::Max(b, c));
    }
};

/// Reads between nodes: down, then across. Down pixel by pixel, since a few nodes of one row are a vector wherever they
/// lie; across many pixels at once.
class LatticeReader {
public:
    /// `lattice` outlives this.
    explicit LatticeReader(const ColourLattice& lattice) : lattice_{&lattice} {}

    /// Asks for what a read at x, y touches, in pixels from the centre of the first one; any values.
    HWY_INLINE void prefetch(float x_px, float y_px) const {
        const glm::ivec2 size = lattice_->size();
        const float x = x_px * kLatticeSteps;
        const float y = y_px * kLatticeSteps;
        if (!(x >= 0.0F && y >= 0.0F && x < static_cast<float>(size.x) && y < static_cast<float>(size.y))) return;
        const std::uint16_t* nodes = lattice_->before(static_cast<int>(x), static_cast<int>(y));
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
    [[nodiscard]] HWY_INLINE LinearColours read(const Taps& taps, std::uint32_t wanted) const {
        return lattice_->is_smooth() ? read_by<CubicMix>(taps, wanted) : read_by<StraightMix>(taps, wanted);
    }

private:
    static constexpr std::ptrdiff_t kChannels = ColourLattice::kChannels;
    static constexpr std::size_t kPixel = 4;  // values: red, green, blue, and one that nobody asks for
    // Values of a pixel's columns.
    template <class Mix>
    static constexpr std::size_t kColumns = kPixel* Mix::kNodes;

    // Of every lane, each twice side by side.
    template <class Mix>
    struct LaneWeights {
        explicit LaneWeights(hn::VFromD<DI> fraction15) {
            Mix::weigh(fraction15, [this](std::size_t index, hn::VFromD<DI> weight) LW_INLINE_LAMBDA {
                hn::Store(hn::BitCast(DU{}, hn::Or(weight, hn::ShiftLeft<16>(weight))), DU{}, pairs[index]);
            });
        }
        HWY_ALIGN std::uint32_t pairs[Mix::kWeights][kMaxLanes];
    };

    template <class Mix>
    [[nodiscard]] HWY_NOINLINE LinearColours read_by(const Taps& taps, std::uint32_t wanted) const {
        HWY_ALIGN std::int32_t first[kMaxLanes];
        const auto stride = hn::Set(DI{}, static_cast<std::int32_t>(lattice_->row_stride()));
        const auto column = hn::Mul(taps.x, hn::Set(DI{}, ColourLattice::kChannels));
        hn::Store(hn::Add(hn::Mul(taps.y, stride), column), DI{}, first);
        constexpr int kBefore = (ColourLattice::kReadNodes - static_cast<int>(Mix::kNodes)) / 2;
        const std::uint16_t* nodes = lattice_->before(kBefore, kBefore);
        const LaneWeights<Mix> down{taps.fy};
        HWY_ALIGN std::int16_t columns[kMaxLanes * kColumns<Mix>];
        for (std::uint32_t others = ~wanted & ((1U << hn::Lanes(DU{})) - 1U); others != 0; others &= others - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(others));
            std::fill_n(columns + kColumns<Mix> * lane, kColumns<Mix>, std::int16_t{0});
        }
        for (; wanted != 0; wanted &= wanted - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(wanted));
            mix_rows(nodes + first[lane], down, lane, columns + kColumns<Mix> * lane);
        }
        HWY_ALIGN std::uint16_t colours[kMaxLanes * kPixel];
        mix_columns(columns, LaneWeights<Mix>{taps.fx}, colours);
        const hn::Rebind<std::uint16_t, DU> d16;
        hn::VFromD<decltype(d16)> red;
        hn::VFromD<decltype(d16)> green;
        hn::VFromD<decltype(d16)> blue;
        hn::VFromD<decltype(d16)> unused;
        hn::LoadInterleaved4(d16, colours, red, green, blue, unused);
        return {hn::PromoteTo(DU{}, red), hn::PromoteTo(DU{}, green), hn::PromoteTo(DU{}, blue)};
    }

#if HWY_TARGET == HWY_SCALAR
    using One = hn::CappedTag<std::int16_t, 1>;

    // `value(node)`, weighed with the weights of a lane.
    template <class Mix, class Value>
    [[nodiscard]] static std::int16_t mixed(const Value& value, const LaneWeights<Mix>& all, std::size_t lane) {
        hn::Vec<One> nodes[Mix::kNodes];
        hn::Vec<One> weights[Mix::kWeights];
        for (std::size_t i = 0; i < Mix::kNodes; ++i) nodes[i] = hn::Set(One{}, value(i));
        for (std::size_t i = 0; i < Mix::kWeights; ++i) {
            weights[i] = hn::Set(One{}, static_cast<std::int16_t>(all.pairs[i][lane] & 0x7FFFU));
        }
        return hn::GetLane(Mix::mixed(nodes, weights));
    }

    template <class Mix>
    void mix_rows(const std::uint16_t* nodes, const LaneWeights<Mix>& down, std::size_t lane,
                  std::int16_t* columns) const {
        for (std::size_t i = 0; i < kColumns<Mix>; ++i) {
            const std::uint16_t* first = nodes + kChannels * static_cast<std::ptrdiff_t>(i / kPixel) + i % kPixel;
            const auto value = [&](std::size_t row) {
                return static_cast<std::int16_t>(first[static_cast<std::ptrdiff_t>(row) * lattice_->row_stride()]);
            };
            columns[i] = mixed(value, down, lane);
        }
    }

    template <class Mix>
    static void mix_columns(const std::int16_t* columns, const LaneWeights<Mix>& across, std::uint16_t* colours) {
        for (std::size_t i = 0; i < kPixel; ++i) {
            const auto value = [&](std::size_t column) { return columns[kPixel * column + i]; };
            colours[i] = static_cast<std::uint16_t>(mixed(value, across, 0));
        }
    }
#else
    // Of as many nodes in as many rows the columns.
    template <class Mix>
    HWY_INLINE void mix_rows(const std::uint16_t* nodes, const LaneWeights<Mix>& down, std::size_t lane,
                             std::int16_t* columns) const {
        const hn::CappedTag<std::int16_t, kColumns<Mix> > d;
        const hn::RepartitionToWide<hn::RebindToUnsigned<decltype(d)> > pairs;
        using V = hn::Vec<decltype(d)>;
        V weights[Mix::kWeights];
        for (std::size_t i = 0; i < Mix::kWeights; ++i) {
            weights[i] = hn::BitCast(d, hn::Set(pairs, down.pairs[i][lane]));
        }
        for (std::size_t column = 0; column < Mix::kNodes; column += hn::Lanes(d) / kPixel) {
            const auto* row = reinterpret_cast<const std::int16_t*>(nodes) + kChannels * column;
            V rows[Mix::kNodes];
            for (std::size_t i = 0; i < Mix::kNodes; ++i, row += lattice_->row_stride()) rows[i] = hn::LoadU(d, row);
            hn::Store(spread(d, Mix::mixed(rows, weights)), d, columns + kPixel * column);
        }
    }

    // Three values of each node become four.
    template <class D>
    [[nodiscard]] static HWY_INLINE hn::Vec<D> spread(D d, hn::Vec<D> nodes) {
        constexpr auto kNone = std::int8_t{-1};
        HWY_ALIGN static constexpr std::int8_t kBytes[16] = {0, 1, 2, 3, 4,  5,  kNone, kNone,
                                                             6, 7, 8, 9, 10, 11, kNone, kNone};
        const hn::Repartition<std::int8_t, D> bytes;
        auto halves = nodes;
        if constexpr (hn::MaxLanes(d) == 16) {
            // Two nodes, which are three pairs, into each half.
            HWY_ALIGN static constexpr std::int32_t kPairs[8] = {0, 1, 2, 0, 3, 4, 5, 0};
            const hn::RepartitionToWide<D> pairs;
            halves =
                hn::BitCast(d, hn::TableLookupLanes(hn::BitCast(pairs, nodes), hn::SetTableIndices(pairs, kPairs)));
        }
        return hn::BitCast(d, hn::TableLookupBytes(hn::BitCast(bytes, halves), hn::LoadDup128(bytes, kBytes)));
    }

    // One 64-bit lane is one node.
    template <class Mix>
    static HWY_INLINE void mix_columns(const std::int16_t* columns, const LaneWeights<Mix>& across,
                                       std::uint16_t* colours) {
        const hn::Repartition<std::uint64_t, DU> nodes;
        const hn::Repartition<std::int16_t, DU> d;
        const hn::Rebind<std::uint32_t, decltype(nodes)> half;
        using V = hn::Vec<decltype(d)>;
        for (std::size_t lane = 0; lane < hn::Lanes(DU{}); lane += hn::Lanes(nodes)) {
            V weights[Mix::kWeights];
            for (std::size_t i = 0; i < Mix::kWeights; ++i) {
                const auto pair = hn::PromoteTo(nodes, hn::Load(half, across.pairs[i] + lane));
                weights[i] = hn::BitCast(d, hn::Or(pair, hn::ShiftLeft<32>(pair)));
            }
            const auto* from = reinterpret_cast<const std::uint64_t*>(columns + kColumns<Mix> * lane);
            hn::Vec<decltype(nodes)> column[Mix::kNodes];
            if constexpr (Mix::kNodes == 2) {
                hn::LoadInterleaved2(nodes, from, column[0], column[1]);
            } else {
                hn::LoadInterleaved4(nodes, from, column[0], column[1], column[2], column[3]);
            }
            V values[Mix::kNodes];
            for (std::size_t i = 0; i < Mix::kNodes; ++i) values[i] = hn::BitCast(d, column[i]);
            hn::Store(Mix::mixed(values, weights), d, reinterpret_cast<std::int16_t*>(colours) + kPixel * lane);
        }
    }
#endif

    const ColourLattice* lattice_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
