/// Reading colours for `surface`: bilinear in linear light, many pixels at once, and back to sRGB.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#undef LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#endif

#include <algorithm>
#include <array>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/linear_colour.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

inline constexpr int kPrefetchRows =
    3;  // blocks are narrow, so that the next rows come before the next lines of this one

/// Where a bilinear read begins, and its fractions in 15 bits; exactly 0 at a pixel centre.
struct Taps {
    hn::VFromD<DI> index;
    hn::VFromD<DI> fx;
    hn::VFromD<DI> fy;
};

/// 15-bit channels of Lanes(DF) pixels.
struct LinearColours {
    hn::VFromD<DU> red_green;  ///< red in the lower half
    hn::VFromD<DU> blue;
};

/// Reads one source image.
class ColourReader {
public:
    /// @param linear  as linearise() makes it; outlives this
    ColourReader(const std::uint64_t* linear, glm::ivec2 size_px)
        : linear_{linear}, size_px_{size_px}, cubics_{srgb_cubics()}, encode_{srgb8_from_linear15_table().data()} {}

    /// Taps at x, y: pixels from the centre of the first pixel. Of the lanes `wanted`; the others' read somewhere in
    /// the image.
    template <class M>
    HWY_INLINE Taps taps_of(VF x_px, VF y_px, M wanted) const {
        const auto within = [&](VF place, int size) {
            return hn::Min(hn::Max(hn::IfThenElseZero(wanted, place), hn::Zero(DF{})),
                           hn::Set(DF{}, static_cast<float>(size - 1)));
        };
        const auto fraction = [&](VF place, hn::VFromD<DI> first) {
            const VF part = hn::Sub(place, hn::ConvertTo(DF{}, first));
            return hn::ConvertTo(DI{}, hn::Min(hn::Mul(part, hn::Set(DF{}, 32768.0F)), hn::Set(DF{}, 32767.0F)));
        };
        const VF x = within(x_px, size_px_.x);
        const VF y = within(y_px, size_px_.y);
        const auto x0 = hn::ConvertTo(DI{}, x);
        const auto y0 = hn::ConvertTo(DI{}, y);
        return {hn::Add(hn::Mul(y0, hn::Set(DI{}, size_px_.x)), x0), fraction(x, x0), fraction(y, y0)};
    }

    /// Colours at the taps.
#if HWY_TARGET == HWY_SCALAR
    HWY_INLINE LinearColours read_bilinear(hn::VFromD<DI> tap, hn::VFromD<DI> fx, hn::VFromD<DI> fy) const {
        const std::uint64_t word = read_word(hn::GetLane(tap), hn::GetLane(fx), hn::GetLane(fy));
        return {hn::Set(DU{}, static_cast<std::uint32_t>(word)),
                hn::Set(DU{}, static_cast<std::uint32_t>(word >> 32U))};
    }
#else
    // One pixel per 128-bit block: its two upper neighbours in one load, its two lower ones in another.
    HWY_INLINE LinearColours read_bilinear(hn::VFromD<DI> tap, hn::VFromD<DI> fx, hn::VFromD<DI> fy) const {
        HWY_ALIGN std::int32_t taps[kMaxLanes];
        hn::Store(tap, DI{}, taps);
        __builtin_prefetch(linear_ + taps[0] + (kPrefetchRows + 1) * size_px_.x);
        __builtin_prefetch(linear_ + taps[kMaxLanes / 2] + (kPrefetchRows + 1) * size_px_.x);
        const auto across = twice_in_halves(fx);
        const auto down = twice_in_halves(fy);
        const auto first = read_blocks(taps, 0, across, down);
        const auto second = read_blocks(taps, 1, across, down);
        const auto third = read_blocks(taps, 2, across, down);
        const auto fourth = read_blocks(taps, 3, across, down);
        const hn::ScalableTag<std::uint64_t> d64;
        const auto low = hn::BitCast(DU{}, hn::ConcatEven(d64, second, first));
        const auto high = hn::BitCast(DU{}, hn::ConcatEven(d64, fourth, third));
        return {hn::ConcatEven(DU{}, high, low), hn::ConcatOdd(DU{}, high, low)};
    }
#endif

    /// One pixel, as read_bilinear would. Rows first, then columns, each step rounded to 15 bits: a + (b - a) *
    /// fraction.
    [[nodiscard]] HWY_INLINE std::uint64_t read_word(std::int32_t tap, std::int32_t fx, std::int32_t fy) const {
        const std::uint64_t* top = linear_ + tap;
        const std::uint64_t* bottom = top + size_px_.x;
#if HWY_TARGET == HWY_SCALAR
        std::uint64_t word = 0;
        for (unsigned shift = 0; shift < 48; shift += 16) {
            const auto at = [&](const std::uint64_t* from) {
                return static_cast<std::int32_t>(*from >> shift & 0xFFFFU);
            };
            const auto mix = [](std::int32_t a, std::int32_t b, std::int32_t f) {
                return a + (((b - a) * f + 0x4000) >> 15);
            };
            const std::int32_t left = mix(at(top), at(bottom), fy);
            const std::int32_t right = mix(at(top + 1), at(bottom + 1), fy);
            word |= static_cast<std::uint64_t>(mix(left, right, fx)) << shift;
        }
        return word;
#else
        const hn::FixedTag<std::int16_t, 8> d16;
        const hn::FixedTag<std::uint64_t, 2> d64;
        const auto above = hn::BitCast(d16, hn::LoadU(d64, top));
        const auto below = hn::BitCast(d16, hn::LoadU(d64, bottom));
        const auto down = hn::Set(d16, static_cast<std::int16_t>(fy));
        const auto across = hn::Set(d16, static_cast<std::int16_t>(fx));
        const auto pair = hn::Add(above, hn::MulFixedPoint15(hn::Sub(below, above), down));
        const auto right = hn::ShiftRightLanes<4>(d16, pair);
        const auto word = hn::Add(pair, hn::MulFixedPoint15(hn::Sub(right, pair), across));
        return hn::GetLane(hn::BitCast(d64, word));
#endif
    }

    /// srgb8_from_linear15 of one channel of a word.
    [[nodiscard]] HWY_INLINE std::uint8_t encoded_word(std::uint64_t word, unsigned shift) const {
        return encode_[word >> shift & 0x7FFFU];
    }

    /// srgb8_from_linear15 of three channels, packed and opaque.
    HWY_INLINE hn::VFromD<DU> encoded(const LinearColours& linear) const {
        const auto mask = hn::Set(DU{}, 0x7FFFU);
        const auto red = encoded_channel(hn::And(linear.red_green, mask));
        const auto green = encoded_channel(hn::And(hn::ShiftRight<16>(linear.red_green), mask));
        const auto blue = encoded_channel(hn::And(linear.blue, mask));
        const auto low = hn::Or(red, hn::ShiftLeft<8>(green));
        return hn::Or(low, hn::Or(hn::ShiftLeft<16>(blue), hn::Set(DU{}, 0xFF000000U)));
    }

private:
#if HWY_TARGET != HWY_SCALAR
    [[nodiscard]] static HWY_INLINE hn::VFromD<DU> twice_in_halves(hn::VFromD<DI> fraction) {
        const auto bits = hn::BitCast(DU{}, fraction);
        return hn::Or(bits, hn::ShiftLeft<16>(bits));
    }

    // The pixels of a quarter of the lanes; each one's channels in the lower half of its block.
    HWY_INLINE hn::Vec<hn::ScalableTag<std::uint64_t> > read_blocks(const std::int32_t* taps, int quarter,
                                                                    hn::VFromD<DU> across, hn::VFromD<DU> down) const {
        const hn::ScalableTag<std::int16_t> d16;
        constexpr int kBlocks = HWY_MAX_BYTES / 16;
        const std::int32_t* first = taps + quarter * kBlocks;
        const auto pixel =
            hn::IndicesFromVec(DF{}, hn::Add(hn::ShiftRight<2>(hn::Iota(DI{}, 0)), hn::Set(DI{}, quarter * kBlocks)));
        const auto fx = hn::BitCast(d16, hn::TableLookupLanes(hn::BitCast(DF{}, across), pixel));
        const auto fy = hn::BitCast(d16, hn::TableLookupLanes(hn::BitCast(DF{}, down), pixel));
        const auto above = hn::BitCast(d16, load_blocks(linear_, first));
        const auto below = hn::BitCast(d16, load_blocks(linear_ + size_px_.x, first));
        const auto pair = hn::Add(above, hn::MulFixedPoint15(hn::Sub(below, above), fy));
        const auto right = hn::BitCast(d16, hn::ShiftRightLanes<4>(d16, pair));
        const auto mixed = hn::Add(pair, hn::MulFixedPoint15(hn::Sub(right, pair), fx));
        return hn::BitCast(hn::ScalableTag<std::uint64_t>{}, mixed);
    }

    [[nodiscard]] static HWY_INLINE hn::Vec<hn::ScalableTag<std::uint64_t> > load_blocks(const std::uint64_t* base,
                                                                                         const std::int32_t* taps) {
        const hn::FixedTag<std::uint64_t, 2> d128;
#if HWY_MAX_BYTES == 64
        const hn::FixedTag<std::uint64_t, 4> d256;
        const auto low = hn::Combine(d256, hn::LoadU(d128, base + taps[1]), hn::LoadU(d128, base + taps[0]));
        const auto high = hn::Combine(d256, hn::LoadU(d128, base + taps[3]), hn::LoadU(d128, base + taps[2]));
        return hn::Combine(hn::ScalableTag<std::uint64_t>{}, high, low);
#elif HWY_MAX_BYTES == 32
        return hn::Combine(hn::ScalableTag<std::uint64_t>{}, hn::LoadU(d128, base + taps[1]),
                           hn::LoadU(d128, base + taps[0]));
#else
        return hn::LoadU(d128, base + taps[0]);
#endif
    }
#endif

    [[nodiscard]] HWY_INLINE hn::VFromD<DU> encoded_channel(hn::VFromD<DU> linear15) const {
        const VF value = hn::ConvertTo(DF{}, hn::BitCast(DI{}, linear15));
        const auto exponent =
            hn::Sub(hn::BitCast(DI{}, hn::ShiftRight<23>(hn::BitCast(DU{}, value))), hn::Set(DI{}, 127));
        const auto octave = hn::Max(exponent, hn::Zero(DI{}));
        const VF third = coefficient(cubics_.third, octave);
        const VF second = coefficient(cubics_.second, octave);
        const VF first = coefficient(cubics_.first, octave);
        const VF constant = coefficient(cubics_.constant, octave);
        VF sum = hn::Add(hn::Mul(third, value), second);
        sum = hn::Add(hn::Mul(sum, value), first);
        sum = hn::Add(hn::Mul(sum, value), constant);
        return hn::BitCast(DU{}, hn::ConvertTo(DI{}, hn::Add(sum, hn::Set(DF{}, 0.5F))));
    }

    [[nodiscard]] static HWY_INLINE VF coefficient(const std::array<float, 16>& table, hn::VFromD<DI> octave) {
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
        return hn::TableLookupLanes(hn::LoadU(DF{}, table.data()), hn::IndicesFromVec(DF{}, octave));
#else
        return hn::GatherIndex(DF{}, table.data(), octave);
#endif
    }

    const std::uint64_t* linear_;
    glm::ivec2 size_px_;
    const SrgbCubics& cubics_;
    const std::uint8_t* encode_;  // the same curve as a table, for reads one by one
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
