/// Reading the colours of a source: bilinear in linear light, many pixels at once, and back to sRGB.

// Once per instruction set: the guard toggles where `#pragma once` would read this file only the first time.
#if defined(LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#undef LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#else
#define LW_WARP_SERVER_METHODS_SURFACE_SAMPLING_H
#endif

#include <algorithm>
#include <array>
#include <cstring>

#include "warp_server/methods/lanes.h"
#include "warp_server/methods/linear_colour.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {

/// Where bilinear reads begin, and their fractions in 15 bits; exactly 0 at a pixel centre.
struct Taps {
    hn::VFromD<DI> x;
    hn::VFromD<DI> y;
    hn::VFromD<DI> fx;
    hn::VFromD<DI> fy;
};

/// Says where that is.
class TapGrid {
public:
    /// Of a picture of this size that has `steps` values from one pixel's centre to the next.
    TapGrid(glm::ivec2 size_px, int steps)
        : scale_{32768.0F * static_cast<float>(steps)},
          last_{static_cast<float>(size_px.x - 1), static_cast<float>(size_px.y - 1)} {}

    /// Taps at x, y: pixels from the centre of the first pixel; clamped to the image.
    [[nodiscard]] HWY_INLINE Taps at(VF x_px, VF y_px) const {
        // Whole pixels and fraction at once: a coordinate below 2^14 times 2^15 is exact in both number formats.
        const auto fixed = [this](VF place, float last) {
            const VF within = hn::Min(hn::Max(place, hn::Zero(DF{})), hn::Set(DF{}, last));
            return truncated(hn::Mul(within, hn::Set(DF{}, scale_)));
        };
        const auto fraction = hn::Set(DI{}, 32767);
        const auto x = fixed(x_px, last_[0]);
        const auto y = fixed(y_px, last_[1]);
        return {hn::ShiftRight<15>(x), hn::ShiftRight<15>(y), hn::And(x, fraction), hn::And(y, fraction)};
    }

    [[nodiscard]] HWY_INLINE bool contains(float x_px, float y_px) const {
        return x_px >= 0.0F && x_px <= last_[0] && y_px >= 0.0F && y_px <= last_[1];
    }

private:
    float scale_;
    std::array<float, 2> last_;  // pixel
};

/// 15-bit channels of Lanes(DF) pixels.
struct LinearColours {
    hn::VFromD<DU> red;
    hn::VFromD<DU> green;
    hn::VFromD<DU> blue;
};

/// Two neighbours in a row of one channel: the left one in the lower half, the right one in the upper.
struct PixelPairs {
    hn::VFromD<DU> top;
    hn::VFromD<DU> bottom;
};

inline constexpr int kShareChannel = 3;

/// Reads one source image.
class ColourReader {
public:
    /// `image` outlives this.
    explicit ColourReader(const LinearImage& image)
        : values_{image.data()},
          has_shares_{image.has_alpha()},
          channel_stride_{image.channel_stride()},
          row_stride_{image.row_stride()},
          taps_{image.size_px(), 1} {}

    /// Taps at x, y: pixels from the centre of the first pixel; clamped to the image.
    [[nodiscard]] HWY_INLINE Taps taps_of(VF x_px, VF y_px) const { return taps_.at(x_px, y_px); }

    /// Asks for the pixels below x, y, as taps_of has them; any values.
    HWY_INLINE void prefetch(float x_px, float y_px) const {
        if (!taps_.contains(x_px, y_px)) return;
        const std::uint16_t* row = values_ + (static_cast<std::ptrdiff_t>(y_px) + 1) * row_stride_;
        for (std::ptrdiff_t channel = 0; channel < 3; ++channel) {
            __builtin_prefetch(row + channel * channel_stride_ + static_cast<std::ptrdiff_t>(x_px));
        }
    }

    /// Asks for a vector's stretch of values of one of the image's rows.
    HWY_INLINE void prefetch_row(int column, int row) const {
        const std::uint16_t* from = values_ + row * row_stride_ + column;
        const auto channel = [&](std::ptrdiff_t index) LW_INLINE_LAMBDA {
            // Both lines that such a read meets: with the first alone `surface` took a fourteenth longer.
            __builtin_prefetch(from + index * channel_stride_);
            __builtin_prefetch(from + index * channel_stride_ + LinearImage::kSpareColumns - 1);
        };
        channel(0);
        channel(1);
        channel(2);
    }

    /// The same some rows below, for the next runs of pixels.
    HWY_INLINE void prefetch_below(int column, int row) const { prefetch_row(column, row + kPrefetchRows); }

    /// Bilinear colours at the taps, which may be anywhere.
    [[nodiscard]] HWY_INLINE LinearColours read(const Taps& taps) const {
        const auto channel = [&](int index) { return mixed(pairs_at(taps, index), taps.fx, taps.fy); };
        return {channel(0), channel(1), channel(2)};
    }

    /// Is there a fourth channel: which share of each pixel its surface covers?
    [[nodiscard]] bool has_shares() const { return has_shares_; }

    /// The four pixels at each tap, of channel 0 (red), 1, 2 or kShareChannel.
    [[nodiscard]] HWY_INLINE PixelPairs pairs_at(const Taps& taps, int channel) const {
        const std::uint16_t* values = values_ + channel * channel_stride_;
#if LW_HAS_WIDE_LOOKUPS
        const auto at = hn::Add(hn::Mul(taps.y, hn::Set(DI{}, static_cast<std::int32_t>(row_stride_))), taps.x);
        constexpr int kBytes = 2;
        return {hn::VFromD<DU>{_mm512_i32gather_epi32(at.raw, values, kBytes)},
                hn::VFromD<DU>{_mm512_i32gather_epi32(at.raw, values + row_stride_, kBytes)}};
#elif HWY_TARGET == HWY_AVX2
        const auto at = hn::Add(hn::Mul(taps.y, hn::Set(DI{}, static_cast<std::int32_t>(row_stride_))), taps.x);
        constexpr int kBytes = 2;
        const auto pairs_from = [&](const std::uint16_t* from) {
            return hn::VFromD<DU>{_mm256_i32gather_epi32(reinterpret_cast<const int*>(from), at.raw, kBytes)};
        };
        return {pairs_from(values), pairs_from(values + row_stride_)};
#else
        HWY_ALIGN std::int32_t x[kMaxLanes];
        HWY_ALIGN std::int32_t y[kMaxLanes];
        HWY_ALIGN std::uint32_t top[kMaxLanes];
        HWY_ALIGN std::uint32_t bottom[kMaxLanes];
        hn::Store(taps.x, DI{}, x);
        hn::Store(taps.y, DI{}, y);
        for (std::size_t lane = 0; lane < hn::Lanes(DF{}); ++lane) {
            const std::uint16_t* from = values + y[lane] * row_stride_ + x[lane];
            std::memcpy(&top[lane], from, sizeof(std::uint32_t));
            std::memcpy(&bottom[lane], from + row_stride_, sizeof(std::uint32_t));
        }
        return {hn::Load(DU{}, top), hn::Load(DU{}, bottom)};
#endif
    }

    /// Colours at the taps of the lanes whose bits are in `wanted`, at least one, and anything at the others. The taps
    /// lie along a line in the source, as they do for pixels of one row on one plane; `x` and `y` are their places
    /// again. Asks for the rows below.
    [[nodiscard]] HWY_INLINE LinearColours read_along(const Taps& taps, std::uint32_t wanted, const std::int32_t* x,
                                                      const std::int32_t* y) const {
        // The ends hold the smallest values; where rounding has it otherwise, no lookup reaches all.
        const auto first = static_cast<unsigned>(__builtin_ctz(wanted));
        const auto last = 31U - static_cast<unsigned>(__builtin_clz(wanted));
        const int first_y = std::min(y[first], y[last]);
        prefetch_below(std::min(x[first], x[last]), first_y);
#if LW_HAS_WIDE_LOOKUPS
        LinearColours colours;
        const auto lanes = lanes_of_bits(DU{}, wanted);
        if (read_wide(taps, lanes, std::min(x[first], x[last]), first_y, colours)) return colours;
        const unsigned middle = (first + last) / 2;  // more than two rows, where the head rolled
        if (read_near(taps, lanes, x[middle], y[middle], colours)) return colours;
#elif HWY_TARGET == HWY_AVX2
        // Each half of the vector has columns of its own; an empty one those of the other.
        constexpr unsigned kHalf = 4;
        const unsigned left_last = std::min(last, kHalf - 1);
        const unsigned right_first = std::max(first, kHalf);
        const int left = first < kHalf ? std::min(x[first], x[left_last]) : std::min(x[first], x[last]);
        const int right = last >= kHalf ? std::min(x[right_first], x[last]) : left;
        LinearColours colours;
        if (read_halves(taps, lanes_of_bits(DU{}, wanted), left, right, first_y, colours)) return colours;
#endif
        return read(taps);
    }

#if LW_HAS_WIDE_LOOKUPS
    /// Colours at the taps of the lanes `wanted`, in any order. False, and nothing read, when they do not all lie near
    /// (x, y): from a row above to two rows below, and about as far to each side as a vector reaches. Several times as
    /// fast as read().
    template <class M>
    [[nodiscard]] HWY_INLINE bool read_near(const Taps& taps, M wanted, int x, int y, LinearColours& colours) const {
        constexpr int kBefore = LinearImage::kSpareColumns / 2 - 1;
        const int first_x = std::max(x - kBefore, 0);
        const int first_y = std::max(y - 1, 0);
        const auto column = hn::Sub(taps.x, hn::Set(DI{}, first_x));
        const auto row = hn::Sub(taps.y, hn::Set(DI{}, first_y));
        constexpr std::uint32_t kLastColumn = LinearImage::kSpareColumns - 2;
        const auto far_column = hn::Gt(hn::BitCast(DU{}, column), hn::Set(DU{}, kLastColumn));
        const auto far_row = hn::Gt(hn::BitCast(DU{}, row), hn::Set(DU{}, 3U));
        if (!hn::AllFalse(DU{}, hn::And(wanted, hn::Or(far_column, far_row)))) return false;

        const auto odd_row = hn::And(row, hn::Set(DI{}, 1));
        const PairLookup at{hn::Add(column, hn::ShiftLeft<5>(odd_row)), taps};
        const __m512i rows = _mm512_broadcast_i64x4(_mm512_cvtepi32_epi16(row.raw));
        const __mmask32 in_lower_two = _mm512_test_epi16_mask(rows, _mm512_set1_epi16(2));
        const std::uint16_t* from = values_ + first_y * row_stride_ + first_x;
        const auto channel = [&](std::ptrdiff_t index) {
            const std::uint16_t* row0 = from + index * channel_stride_;
            const auto values = [&](std::ptrdiff_t line) { return _mm512_loadu_si512(row0 + line * row_stride_); };
            const __m512i values1 = values(1);
            const __m512i values2 = values(2);
            const __m512i values3 = values(3);
            const auto lookup = [&](__m512i upper0, __m512i upper1, __m512i lower0, __m512i lower1) {
                return _mm512_mask_blend_epi16(in_lower_two, _mm512_permutex2var_epi16(upper0, at.entry, upper1),
                                               _mm512_permutex2var_epi16(lower0, at.entry, lower1));
            };
            return at.mixed(lookup(values(0), values1, values2, values3), lookup(values1, values2, values3, values(4)));
        };
        colours = {channel(0), channel(1), channel(2)};
        return true;
    }
#endif

private:
    static constexpr std::ptrdiff_t kPrefetchRows = 5;  // those below the rows that the next runs read

#if HWY_TARGET == HWY_AVX2
    // Colours at the taps of the lanes `wanted`, of which the lower half begin at column `left`, the others at `right`.
    // False, and nothing read, when they do not lie in two rows from first_y on and 16 columns each, with their right
    // and lower neighbours. A lookup takes bytes from 16 of its own half: two of them reach 16 columns, and what is not
    // in one is 0 there.
    template <class M>
    [[nodiscard]] HWY_INLINE bool read_halves(const Taps& taps, M wanted, int left, int right, int first_y,
                                              LinearColours& colours) const {
        const __m256i begin = _mm256_set_m128i(_mm_set1_epi32(right), _mm_set1_epi32(left));
        const auto column = hn::Sub(taps.x, hn::VFromD<DI>{begin});
        const auto below_first = hn::Sub(taps.y, hn::Set(DI{}, first_y));
        constexpr std::uint32_t kLastColumn = 14;
        const auto far_column = hn::Gt(hn::BitCast(DU{}, column), hn::Set(DU{}, kLastColumn));
        const auto far_row = hn::Gt(hn::BitCast(DU{}, below_first), hn::Set(DU{}, 1U));
        if (!hn::AllFalse(DU{}, hn::And(wanted, hn::Or(far_column, far_row)))) return false;

        const __m128i first_byte = _mm_setr_epi8(0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
        const __m256i bytes =
            _mm256_add_epi8(_mm256_shuffle_epi8(hn::Add(column, column).raw, _mm256_broadcastsi128_si256(first_byte)),
                            _mm256_set1_epi32(0x03020100));
        const __m256i in_first = _mm256_add_epi8(bytes, _mm256_set1_epi8(0x70));   // top bit set from 16 on
        const __m256i in_second = _mm256_sub_epi8(bytes, _mm256_set1_epi8(0x10));  // and below 16
        const __m256 in_lower = _mm256_castsi256_ps(_mm256_slli_epi32(below_first.raw, 31));
        const std::uint16_t* from = values_ + first_y * row_stride_;
        const auto channel = [&](std::ptrdiff_t index) LW_INLINE_LAMBDA {
            const auto pairs_in = [&](std::ptrdiff_t row) LW_INLINE_LAMBDA {
                const std::uint16_t* values = from + row * row_stride_ + index * channel_stride_;
                const auto both = [&](std::ptrdiff_t by) LW_INLINE_LAMBDA {
                    const auto half = [](const std::uint16_t* at) {
                        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
                    };
                    return _mm256_set_m128i(half(values + right + by), half(values + left + by));
                };
                const __m256i pairs =
                    _mm256_or_si256(_mm256_shuffle_epi8(both(0), in_first), _mm256_shuffle_epi8(both(8), in_second));
                return _mm256_castsi256_ps(pairs);
            };
            const __m256 middle = pairs_in(1);
            const auto chosen = [&](__m256 upper, __m256 lower) LW_INLINE_LAMBDA {
                return hn::VFromD<DU>{_mm256_castps_si256(_mm256_blendv_ps(upper, lower, in_lower))};
            };
            return mixed({chosen(pairs_in(0), middle), chosen(middle, pairs_in(2))}, taps.fx, taps.fy);
        };
        colours = {channel(0), channel(1), channel(2)};
        return true;
    }
#endif

#if LW_HAS_WIDE_LOOKUPS
    // Colours at the taps of the lanes `wanted`. False, and nothing read, when they do not lie in two rows and one
    // vector's stretch of columns from (first_x, first_y) on, with their right and lower neighbours.
    template <class M>
    [[nodiscard]] HWY_INLINE bool read_wide(const Taps& taps, M wanted, int first_x, int first_y,
                                            LinearColours& colours) const {
        const auto column = hn::Sub(taps.x, hn::Set(DI{}, first_x));
        const auto below_first = hn::Sub(taps.y, hn::Set(DI{}, first_y));
        constexpr std::uint32_t kLastColumn = LinearImage::kSpareColumns - 2;
        const auto far_column = hn::Gt(hn::BitCast(DU{}, column), hn::Set(DU{}, kLastColumn));
        const auto far_row = hn::Gt(hn::BitCast(DU{}, below_first), hn::Set(DU{}, 1U));
        if (!hn::AllFalse(DU{}, hn::And(wanted, hn::Or(far_column, far_row)))) return false;

        // Entries of two rows lie in two vectors, so that bit 5 of a lookup says which row.
        const PairLookup at{hn::Add(column, hn::ShiftLeft<5>(below_first)), taps};
        const std::uint16_t* from = values_ + first_y * row_stride_ + first_x;
        const auto channel = [&](std::ptrdiff_t index) {
            const std::uint16_t* row0 = from + index * channel_stride_;
            const __m512i above = _mm512_loadu_si512(row0);
            const __m512i middle = _mm512_loadu_si512(row0 + row_stride_);
            const __m512i below = _mm512_loadu_si512(row0 + 2 * row_stride_);
            return at.mixed(_mm512_permutex2var_epi16(above, at.entry, middle),
                            _mm512_permutex2var_epi16(middle, at.entry, below));
        };
        colours = {channel(0), channel(1), channel(2)};
        return true;
    }
    // Looks up left neighbours in the lower half of the lanes and right ones in the upper half, and mixes them as
    // mixed() below does.
    struct PairLookup {
        PairLookup(hn::VFromD<DI> left_entry, const Taps& taps)
            : fx{_mm512_cvtepi32_epi16(taps.fx.raw)}, fy{_mm512_broadcast_i64x4(_mm512_cvtepi32_epi16(taps.fy.raw))} {
            const __m256i left = _mm512_cvtepi32_epi16(left_entry.raw);
            const __m256i right = _mm256_add_epi16(left, _mm256_set1_epi16(1));
            entry = _mm512_inserti64x4(_mm512_castsi256_si512(left), right, 1);
        }

        [[nodiscard]] HWY_INLINE hn::VFromD<DU> mixed(__m512i top, __m512i bottom) const {
            const __m512i pair = _mm512_add_epi16(top, _mm512_mulhrs_epi16(_mm512_sub_epi16(bottom, top), fy));
            const __m256i left = _mm512_castsi512_si256(pair);
            const __m256i right = _mm512_extracti64x4_epi64(pair, 1);
            const __m256i value = _mm256_add_epi16(left, _mm256_mulhrs_epi16(_mm256_sub_epi16(right, left), fx));
            return hn::VFromD<DU>{_mm512_cvtepu16_epi32(value)};
        }

        __m512i entry;
        __m256i fx;
        __m512i fy;
    };
#endif

    // Down first, then across, each step rounded to 15 bits: a + (b - a) * fraction.
    [[nodiscard]] static HWY_INLINE hn::VFromD<DU> mixed(const PixelPairs& pairs, hn::VFromD<DI> fx,
                                                         hn::VFromD<DI> fy) {
        const auto low = hn::Set(DU{}, 0xFFFFU);
        const auto top = pairs.top;
        const auto down = hn::BitCast(DU{}, hn::Or(fy, hn::ShiftLeft<16>(fy)));
        const auto pair = mixed_halves(top, pairs.bottom, down);
        const auto right = hn::ShiftRight<16>(pair);
        return hn::And(mixed_halves(pair, right, hn::BitCast(DU{}, fx)), low);
    }

    // Of both 16-bit halves of each lane.
    [[nodiscard]] static HWY_INLINE hn::VFromD<DU> mixed_halves(hn::VFromD<DU> a, hn::VFromD<DU> b,
                                                                hn::VFromD<DU> fraction) {
#if HWY_TARGET == HWY_SCALAR
        const auto half = [&](unsigned shift) {
            const auto value = [&](hn::VFromD<DU> from) {
                return static_cast<std::int32_t>(static_cast<std::int16_t>(hn::GetLane(from) >> shift & 0xFFFFU));
            };
            const std::int32_t step = static_cast<std::int16_t>(value(b) - value(a));
            const std::int32_t mixed = value(a) + ((step * value(fraction) + 0x4000) >> 15);
            return (static_cast<std::uint32_t>(mixed) & 0xFFFFU) << shift;
        };
        return hn::Set(DU{}, half(0) | half(16));
#else
        const hn::Repartition<std::int16_t, DU> d16;
        const auto from = hn::BitCast(d16, a);
        const auto step = hn::Sub(hn::BitCast(d16, b), from);
        return hn::BitCast(DU{}, hn::Add(from, hn::MulFixedPoint15(step, hn::BitCast(d16, fraction))));
#endif
    }

    const std::uint16_t* values_;
    bool has_shares_;
    std::ptrdiff_t channel_stride_;
    std::ptrdiff_t row_stride_;
    TapGrid taps_;
};

/// Encodes linear light as sRGB.
class ColourEncoder {
public:
    ColourEncoder() : parabolas_{srgb_parabolas()} {}

    /// srgb8_from_linear15 of three channels, packed and opaque.
    [[nodiscard]] HWY_INLINE hn::VFromD<DU> encoded(const LinearColours& linear) const {
        // Above its lowest byte each holds what kRoundingOffset left: shifted out, or overwritten by the opaque alpha.
        const auto red = hn::Or(channel(linear.red), hn::Set(DU{}, 0xFF000000U));
        const auto green = hn::ShiftLeft<8>(channel(linear.green));
        const auto blue = hn::ShiftLeft<16>(channel(linear.blue));
        return hn::Or(red, hn::Or(green, blue));
    }

private:
    [[nodiscard]] HWY_INLINE hn::VFromD<DU> channel(hn::VFromD<DU> linear15) const {
        const VF value = hn::Add(hn::ConvertTo(DF{}, hn::BitCast(DI{}, linear15)), hn::Set(DF{}, 1.0F));
        const auto entry = hn::ShiftRight<22>(hn::BitCast(DU{}, value));
        VF sum = hn::Add(hn::Mul(coefficient(parabolas_.second, entry), value), coefficient(parabolas_.first, entry));
        sum = hn::Add(hn::Mul(sum, value), coefficient(parabolas_.constant, entry));
        return hn::BitCast(DU{}, hn::Add(sum, hn::Set(DF{}, kRoundingOffset)));
    }

    // `entry` is 254 too large.
    [[nodiscard]] static HWY_INLINE VF coefficient(const std::array<float, 32>& table, hn::VFromD<DU> entry) {
#if LW_HAS_WIDE_LOOKUPS
        // Lookups take the lowest five bits, and 254 is 30 beyond 7 * 32: the table begins two entries late.
        const __m512 low = _mm512_load_ps(table.data());
        const __m512 high = _mm512_load_ps(table.data() + 16);
        return VF{_mm512_permutex2var_ps(low, _mm512_add_epi32(entry.raw, _mm512_set1_epi32(2)), high)};
#elif HWY_TARGET == HWY_AVX2
        // A lookup takes the lowest three bits, the next two choose among four of them. With gathers instead `surface`
        // took a fifth longer.
        const __m256i at = _mm256_add_epi32(entry.raw, _mm256_set1_epi32(2));
        const auto eight = [&](int first) {
            return _mm256_permutevar8x32_ps(_mm256_load_ps(table.data() + first), at);
        };
        const __m256 odd_eight = _mm256_castsi256_ps(_mm256_slli_epi32(at, 28));
        const __m256 upper_sixteen = _mm256_castsi256_ps(_mm256_slli_epi32(at, 27));
        return VF{_mm256_blendv_ps(_mm256_blendv_ps(eight(0), eight(8), odd_eight),
                                   _mm256_blendv_ps(eight(16), eight(24), odd_eight), upper_sixteen)};
#else
        const auto at = hn::Sub(hn::BitCast(DI{}, entry), hn::Set(DI{}, 254));
        return hn::GatherIndex(DF{}, table.data(), at);
#endif
    }

    const SrgbParabolas& parabolas_;
};

}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
