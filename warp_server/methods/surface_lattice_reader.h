/// Reading colours between the nodes of a ColourLattice.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#undef LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_LATTICE_READER_H
#endif

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
/// Pixel by pixel: a row of four nodes is one vector of 16 values wherever it lies, and all channels come at once.
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

    /// Asks for what a vector of taps reads that begins at this node: of pixels as large as the target's, of one row.
    HWY_INLINE void prefetch_row(int column, int row) const {
        const std::uint16_t* nodes = lattice_->before(column, row);
        constexpr std::size_t kLine = 64 / sizeof(std::uint16_t);
        for (std::size_t line = 0; line < ColourLattice::kReadNodes; ++line, nodes += lattice_->row_stride()) {
            for (std::size_t at = 0; at <= kLatticeSteps * kChannels * hn::Lanes(DF{}); at += kLine) {
                __builtin_prefetch(nodes + at);
            }
        }
    }

    /// ColourReader::read_along.
    [[nodiscard]] HWY_INLINE LinearColours read_along(const Taps& taps, std::uint32_t wanted, const std::int32_t* x,
                                                      const std::int32_t* y) const {
        static_cast<void>(x), static_cast<void>(y);
        return read(taps, wanted);
    }

    /// Colours at the taps, nodes and fractions, of the lanes whose bits are in `wanted`, and anything at the others.
    [[nodiscard]] HWY_NOINLINE LinearColours read(const Taps& taps, std::uint32_t wanted) const {
        HWY_ALIGN std::int32_t x[kMaxLanes];
        HWY_ALIGN std::int32_t y[kMaxLanes];
        hn::Store(taps.x, DI{}, x);
        hn::Store(taps.y, DI{}, y);
        const LaneWeights across{taps.fx};
        const LaneWeights down{taps.fy};
        HWY_ALIGN std::uint16_t colours[kMaxLanes * kChannels] = {};
        for (; wanted != 0; wanted &= wanted - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(wanted));
            read_one(lattice_->before(x[lane], y[lane]), down.of(lane), across.of(lane), colours + kChannels * lane);
        }
        const hn::Rebind<std::uint16_t, DU> d16;
        hn::VFromD<decltype(d16)> red;
        hn::VFromD<decltype(d16)> green;
        hn::VFromD<decltype(d16)> blue;
        hn::VFromD<decltype(d16)> unused;
        hn::LoadInterleaved4(d16, colours, red, green, blue, unused);
        return {hn::PromoteTo(DU{}, red), hn::PromoteTo(DU{}, green), hn::PromoteTo(DU{}, blue)};
    }

private:
    static constexpr std::size_t kChannels = ColourLattice::kChannels;
    static constexpr std::size_t kRow = kChannels * ColourLattice::kReadNodes;

    // Between b and c of four values a, b, c, d, in 15 bits:
    //   b + step * (c - b) + before * (b - a) - after * (d - c).
    struct Weights {
        std::int16_t step;
        std::int16_t before;
        std::int16_t after;
    };

    // Those of every lane. With f the fraction, before = f (1 - f)^2 / 2, after = f^2 (1 - f) / 2, step = f - before +
    // after, rounded so that it stays below 1.
    class LaneWeights {
    public:
        explicit LaneWeights(hn::VFromD<DI> fraction15) {
            const VF fraction = hn::Mul(hn::ConvertTo(DF{}, fraction15), hn::Set(DF{}, 1.0F / 32768.0F));
            const VF left = hn::Sub(hn::Set(DF{}, 1.0F), fraction);
            const VF half = hn::Mul(hn::Mul(fraction, left), hn::Set(DF{}, 16384.0F));
            const auto before = truncated(hn::Mul(half, left));
            const auto after = truncated(hn::Mul(half, fraction));
            hn::Store(before, DI{}, before_);
            hn::Store(after, DI{}, after_);
            hn::Store(hn::Add(hn::Sub(fraction15, before), after), DI{}, step_);
        }
        [[nodiscard]] HWY_INLINE Weights of(std::size_t lane) const {
            return {static_cast<std::int16_t>(step_[lane]), static_cast<std::int16_t>(before_[lane]),
                    static_cast<std::int16_t>(after_[lane])};
        }

    private:
        HWY_ALIGN std::int32_t step_[kMaxLanes];
        HWY_ALIGN std::int32_t before_[kMaxLanes];
        HWY_ALIGN std::int32_t after_[kMaxLanes];
    };

    HWY_INLINE void read_one(const std::uint16_t* nodes, Weights down, Weights across, std::uint16_t* colour) const {
        const hn::CappedTag<std::int16_t, kRow> row;
        const auto* first = reinterpret_cast<const std::int16_t*>(nodes);
        const std::ptrdiff_t stride = lattice_->row_stride();
        HWY_ALIGN std::int16_t columns[kRow];
        for (std::size_t i = 0; i < kRow; i += hn::Lanes(row)) {
            const auto load = [&](std::ptrdiff_t line)
                                  LW_INLINE_LAMBDA { return hn::LoadU(row, first + line * stride + i); };
            hn::Store(between(row, load(0), load(1), load(2), load(3), down), row, columns + i);
        }
        const hn::CappedTag<std::int16_t, kChannels> node;
        for (std::size_t i = 0; i < kChannels; i += hn::Lanes(node)) {
            const auto load = [&](std::size_t column)
                                  LW_INLINE_LAMBDA { return hn::Load(node, columns + column * kChannels + i); };
            hn::Store(between(node, load(0), load(1), load(2), load(3), across), node,
                      reinterpret_cast<std::int16_t*>(colour) + i);
        }
    }

    template <class D, class V = hn::Vec<D>>
    [[nodiscard]] static HWY_INLINE V between(D d16, V a, V b, V c, V d, Weights weights) {
        const auto part = [&](V from, V to, std::int16_t weight)
                              LW_INLINE_LAMBDA { return hn::MulFixedPoint15(hn::Sub(to, from), hn::Set(d16, weight)); };
        const V bend = hn::Sub(part(a, b, weights.before), part(c, d, weights.after));
        const V value = hn::SaturatedAdd(b, hn::SaturatedAdd(part(b, c, weights.step), bend));
        return hn::Min(hn::Max(value, hn::Min(b, c)), hn::Max(b, c));
    }

    const ColourLattice* lattice_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
