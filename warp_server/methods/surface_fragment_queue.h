/// Pixels of `surface` in which surfaces meet, collected until they fill vectors.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_FRAGMENT_QUEUE_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_FRAGMENT_QUEUE_H
#undef LW_WARP_SERVER_METHODS_SURFACE_FRAGMENT_QUEUE_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_FRAGMENT_QUEUE_H
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_edge_lattice.h"
#include "warp_server/methods/surface_queues.h"
#include "warp_server/methods/surface_sampling.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

inline constexpr int kTrustShift = 8;
inline constexpr float kFullTrust = 255.0F;

/// Pixels in cells where surfaces meet: each surface weighs its own corners alone, and covers as much as they weigh.
class FragmentQueue {
public:
    /// `lattices` (PreparedSurface::edge_lattices) outlive this; without any the cells' pixels are read.
    FragmentQueue(const ColourReader& reader, const std::uint16_t* lattices, glm::ivec2 source_size_px,
                  SurfaceCanvas& canvas)
        : reader_{reader},
          lattices_{lattices},
          last_x_{source_size_px.x - 1},
          last_y_{source_size_px.y - 1},
          canvas_{canvas} {}

    /// Are cells known by their numbers?
    [[nodiscard]] bool has_lattices() const { return lattices_ != nullptr; }

    /// The lanes `wanted`: target pixel number `pixel` of depth `depth` shows the surface that owns `corners` (bits
    /// 1 << corner) of the source's cell at x, y, at the place u, v in it; what is outside of the cell counts as its
    /// rim. From bit kTrustShift on `corners` has what share of kFullTrust the pixels' shares count. With lattices `x`
    /// is the cell's number, and `y` says nothing.
    template <class M>
    HWY_INLINE void push(M wanted, hn::VFromD<DI> pixel, VF depth, hn::VFromD<DI> x, hn::VFromD<DI> y, VF u, VF v,
                         hn::VFromD<DI> corners) {
        append_lanes(DI{}, pixel, wanted, pixel_ + count_);
        append_lanes(DF{}, depth, wanted, depth_ + count_);
        append_lanes(DI{}, x, wanted, x_ + count_);
        if (!has_lattices()) append_lanes(DI{}, y, wanted, y_ + count_);
        append_lanes(DF{}, u, wanted, u_ + count_);
        append_lanes(DF{}, v, wanted, v_ + count_);
        append_lanes(DI{}, corners, wanted, corners_ + count_);
        const std::size_t wanted_count = hn::CountTrue(DF{}, wanted);
        if (has_lattices()) {
            // Asked for early, because the values of an edge lie by themselves.
            for (std::size_t i = count_; i < count_ + wanted_count; i += 2) {
                __builtin_prefetch(lattices_ + static_cast<std::ptrdiff_t>(x_[i]) * kEdgeValues);
            }
        }
        count_ += wanted_count;
        if (count_ >= kBatch) flush();
    }

    HWY_NOINLINE void flush() {
        hn::StoreU(hn::Zero(DI{}), DI{}, x_ + count_);  // what a store left beyond the end may be no cell at all
        hn::StoreU(hn::Zero(DI{}), DI{}, y_ + count_);
        for (std::size_t i = 0; i < count_; i += hn::Lanes(DF{})) {
            if (has_lattices()) {
                flush_lattices(i);
            } else {
                flush_vector(i);
            }
        }
        count_ = 0;
    }

private:
    // Of the pixel's own cell: a rectangle of areas around the corners.
    struct CornerAreas {
        VF of0, of1, of2, of3;
    };

    static constexpr float kSmallestCoverage = 1.0F / 512.0F;  // less changes no 8-bit colour
    static constexpr float kLeastWeight =
        1e-3F;  // a surface has a colour where none of its own corners weighs anything

    [[nodiscard]] static HWY_INLINE VF left_of(hn::VFromD<DU> pair) {
        return hn::ConvertTo(DF{}, hn::BitCast(DI{}, hn::And(pair, hn::Set(DU{}, 0xFFFFU))));
    }
    [[nodiscard]] static HWY_INLINE VF right_of(hn::VFromD<DU> pair) {
        return hn::ConvertTo(DF{}, hn::BitCast(DI{}, hn::ShiftRight<16>(pair)));
    }

    [[nodiscard]] static HWY_INLINE CornerAreas areas_at(VF u, VF v) {
        const VF one = hn::Set(DF{}, 1.0F);
        return {hn::Mul(hn::Sub(one, u), hn::Sub(one, v)), hn::Mul(u, hn::Sub(one, v)), hn::Mul(hn::Sub(one, u), v),
                hn::Mul(u, v)};
    }

    [[nodiscard]] static HWY_INLINE VF own_part(hn::VFromD<DI> corners, int corner, VF weight) {
        return hn::IfThenElseZero(hn::RebindMask(DF{}, hn::TestBit(corners, hn::Set(DI{}, 1 << corner))), weight);
    }

    // The mean over a pixel's area of what the edge's lattice has, which is bilinear between its nodes.
    HWY_INLINE void flush_lattices(std::size_t i) {
        const VF zero = hn::Zero(DF{});
        const VF one = hn::Set(DF{}, 1.0F);
        const VF u = hn::Min(hn::Max(hn::Load(DF{}, u_ + i), zero), one);
        const VF v = hn::Min(hn::Max(hn::Load(DF{}, v_ + i), zero), one);
        const auto corners = hn::Load(DI{}, corners_ + i);
        const VF half = hn::Set(DF{}, 0.5F);
        const auto right = hn::Ge(u, half);
        const auto lower = hn::Ge(v, half);
        const auto first = hn::Add(hn::IfThenElseZero(hn::RebindMask(DI{}, right), hn::Set(DI{}, 1)),
                                   hn::IfThenElseZero(hn::RebindMask(DI{}, lower), hn::Set(DI{}, kEdgeNodes)));
        const auto at = hn::Add(hn::Mul(hn::Load(DI{}, x_ + i), hn::Set(DI{}, kEdgeValues)), first);
        const auto between = [&](VF place, hn::Mask<DF> second) {
            return hn::Sub(hn::Add(place, place), hn::IfThenElseZero(second, one));
        };
        const CornerAreas nodes = areas_at(between(u, right), between(v, lower));
        const auto channel = [&](int index) {
            const PixelPairs pairs = lattice_pairs(at, index);
            const VF top = hn::Add(hn::Mul(nodes.of0, left_of(pairs.top)), hn::Mul(nodes.of1, right_of(pairs.top)));
            const VF bottom =
                hn::Add(hn::Mul(nodes.of2, left_of(pairs.bottom)), hn::Mul(nodes.of3, right_of(pairs.bottom)));
            return hn::Add(top, bottom);
        };
        const VF share = channel(kEdgeShareChannel);
        // Less of it where the picture hardly moves, which shows the source as it is.
        const CornerAreas areas = areas_at(u, v);
        const VF of_pixels = hn::Add(hn::Add(own_part(corners, 0, areas.of0), own_part(corners, 1, areas.of1)),
                                     hn::Add(own_part(corners, 2, areas.of2), own_part(corners, 3, areas.of3)));
        const VF trust =
            hn::Mul(hn::ConvertTo(DF{}, hn::ShiftRight<kTrustShift>(corners)), hn::Set(DF{}, 1.0F / kFullTrust));
        const VF of_quarters = hn::Mul(share, hn::Set(DF{}, 1.0F / static_cast<float>(kLinearOne)));
        const VF coverage = hn::Add(of_pixels, hn::Mul(trust, hn::Sub(of_quarters, of_pixels)));
        const VF scale = hn::Div(hn::Set(DF{}, static_cast<float>(kLinearOne)), hn::Max(share, one));
        put(i, hn::Min(coverage, one), hn::Mul(channel(0), scale), hn::Mul(channel(1), scale),
            hn::Mul(channel(2), scale));
    }

    // Two nodes in a row from `at` on, and the two below, of one channel.
    [[nodiscard]] HWY_INLINE PixelPairs lattice_pairs(hn::VFromD<DI> at, int channel) const {
        const std::uint16_t* values = lattices_ + channel * kEdgeChannel;
#if LW_HAS_WIDE_LOOKUPS
        constexpr int kBytes = 2;
        return {hn::VFromD<DU>{_mm512_i32gather_epi32(at.raw, values, kBytes)},
                hn::VFromD<DU>{_mm512_i32gather_epi32(at.raw, values + kEdgeNodes, kBytes)}};
#else
        HWY_ALIGN std::int32_t first[kMaxLanes];
        HWY_ALIGN std::uint32_t top[kMaxLanes];
        HWY_ALIGN std::uint32_t bottom[kMaxLanes];
        hn::Store(at, DI{}, first);
        for (std::size_t lane = 0; lane < hn::Lanes(DF{}); ++lane) {
            std::memcpy(&top[lane], values + first[lane], sizeof(std::uint32_t));
            std::memcpy(&bottom[lane], values + first[lane] + kEdgeNodes, sizeof(std::uint32_t));
        }
        return {hn::Load(DU{}, top), hn::Load(DU{}, bottom)};
#endif
    }

    HWY_INLINE void put(std::size_t i, VF coverage, VF red_15, VF green_15, VF blue_15) {
        const auto whole = [](VF value) {
            const VF most = hn::Set(DF{}, static_cast<float>(kLinearOne));
            const VF rounded = hn::Add(hn::Min(value, most), hn::Set(DF{}, 0.5F));
            return hn::BitCast(DU{}, truncated(rounded));
        };
        const auto word = [](auto first, auto second) { return hn::Or(first, hn::ShiftLeft<16>(second)); };
        const auto coverage_15 = whole(hn::Mul(coverage, hn::Set(DF{}, static_cast<float>(kLinearOne))));
        HWY_ALIGN std::uint32_t words[4 * kMaxLanes];
        hn::StoreInterleaved4(hn::BitCast(DU{}, hn::Load(DF{}, depth_ + i)), word(whole(red_15), coverage_15),
                              word(whole(blue_15), whole(green_15)), hn::Zero(DU{}), DU{}, words);
        const std::size_t end = std::min(hn::Lanes(DF{}), count_ - i);
        std::uint32_t bits = bits_of(DF{}, hn::Ge(coverage, hn::Set(DF{}, kSmallestCoverage)));
        for (bits &= (1U << end) - 1U; bits != 0; bits &= bits - 1) {
            const auto lane = static_cast<std::size_t>(__builtin_ctz(bits));
            SurfaceFragment fragment;
            std::memcpy(&fragment, words + 4 * lane, sizeof(fragment));
            canvas_.put_fragment(static_cast<std::size_t>(pixel_[i + lane]), fragment);
        }
    }

    HWY_INLINE void flush_vector(std::size_t i) {
        const VF one = hn::Set(DF{}, 1.0F);
        const auto x = hn::Load(DI{}, x_ + i);
        const auto y = hn::Load(DI{}, y_ + i);
        // Beyond the last column and row the last pixels count again.
        const auto place = [&](const float* values, hn::VFromD<DI> cell, int last) {
            const VF room = hn::ConvertTo(DF{}, hn::Sub(hn::Set(DI{}, last), cell));
            return hn::Min(hn::Max(hn::Load(DF{}, values + i), hn::Zero(DF{})), hn::Min(room, one));
        };
        const VF u = place(u_, x, last_x_);
        const VF v = place(v_, y, last_y_);
        const auto corners = hn::Load(DI{}, corners_ + i);
        const auto own = [&](int corner, VF weight) { return own_part(corners, corner, weight); };
        const auto [area0, area1, area2, area3] = areas_at(u, v);
        const Taps taps{x, y, hn::Zero(DI{}), hn::Zero(DI{})};
        VF coverage = hn::Add(hn::Add(own(0, area0), own(1, area1)), hn::Add(own(2, area2), own(3, area3)));
        VF least = hn::Zero(DF{});
        if (reader_.has_shares()) {
            // The edge runs where the shares of the pixels beside it say: what its own pixels lack moves it inwards,
            // what the others lack outwards. Less so where the picture hardly moves, which shows the source as it is.
            const VF whole = hn::Set(DF{}, static_cast<float>(kLinearOne));
            const VF trust = hn::Mul(hn::ConvertTo(DF{}, hn::ShiftRight<kTrustShift>(corners)),
                                     hn::Set(DF{}, 1.0F / (kFullTrust * static_cast<float>(kLinearOne))));
            const PixelPairs shares = reader_.pairs_at(taps, kShareChannel);
            const auto lack = [&](VF area, VF share) { return hn::Mul(area, hn::Sub(whole, share)); };
            const VF lack0 = lack(area0, left_of(shares.top));
            const VF lack1 = lack(area1, right_of(shares.top));
            const VF lack2 = lack(area2, left_of(shares.bottom));
            const VF lack3 = lack(area3, right_of(shares.bottom));
            const VF all = hn::Add(hn::Add(lack0, lack1), hn::Add(lack2, lack3));
            const VF inwards = hn::Add(hn::Add(own(0, lack0), own(1, lack1)), hn::Add(own(2, lack2), own(3, lack3)));
            const auto mean = [](VF sum, VF area) { return hn::Div(sum, hn::Max(area, hn::Set(DF{}, kLeastWeight))); };
            const VF shift = hn::Sub(mean(hn::Sub(all, inwards), hn::Sub(one, coverage)), mean(inwards, coverage));
            coverage = hn::Min(hn::Max(hn::Add(coverage, hn::Mul(trust, shift)), hn::Zero(DF{})), one);
            least = hn::Set(DF{}, kLeastWeight);
        }
        const VF weight0 = own(0, hn::Add(area0, least));
        const VF weight1 = own(1, hn::Add(area1, least));
        const VF weight2 = own(2, hn::Add(area2, least));
        const VF weight3 = own(3, hn::Add(area3, least));
        const VF scale = hn::Div(one, hn::Add(hn::Add(weight0, weight1), hn::Add(weight2, weight3)));
        const auto channel = [&](int index) {
            const PixelPairs pairs = reader_.pairs_at(taps, index);
            const VF top = hn::Add(hn::Mul(weight0, left_of(pairs.top)), hn::Mul(weight1, right_of(pairs.top)));
            const VF bottom =
                hn::Add(hn::Mul(weight2, left_of(pairs.bottom)), hn::Mul(weight3, right_of(pairs.bottom)));
            return hn::Mul(hn::Add(top, bottom), scale);
        };
        put(i, coverage, channel(0), channel(1), channel(2));
    }

    const ColourReader& reader_;
    const std::uint16_t* lattices_;
    int last_x_;
    int last_y_;
    SurfaceCanvas& canvas_;
    std::size_t count_ = 0;
    HWY_ALIGN std::int32_t pixel_[kQueueRoom];
    HWY_ALIGN float depth_[kQueueRoom];
    HWY_ALIGN std::int32_t x_[kQueueRoom];
    HWY_ALIGN std::int32_t y_[kQueueRoom];
    HWY_ALIGN float u_[kQueueRoom];
    HWY_ALIGN float v_[kQueueRoom];
    HWY_ALIGN std::int32_t corners_[kQueueRoom];
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
