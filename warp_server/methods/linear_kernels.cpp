#include "warp_server/methods/linear_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "warp_server/methods/linear_kernels.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, as it asks.
#include <hwy/highway.h>

#include <algorithm>

#include "warp_server/methods/lanes.h"

HWY_BEFORE_NAMESPACE();
namespace lw::HWY_NAMESPACE {
namespace {

// One row of one or more pixels.
void linearise_one_by_one(const Rgba8* pixels, std::size_t count, const std::uint16_t* linear, std::uint16_t* out,
                          std::size_t channel_stride) {
    for (std::size_t x = 0; x < count; ++x) {
        out[x] = linear[pixels[x].r];
        out[x + channel_stride] = linear[pixels[x].g];
        out[x + 2 * channel_stride] = linear[pixels[x].b];
    }
}

#if LW_HAS_WIDE_LOOKUPS

// Thirty-two bytes of one channel, looked up among the 256 entries of the table: 64 at a time, chosen by their two top
// bits.
class ChannelLookup {
public:
    explicit ChannelLookup(const std::uint16_t* linear) {
        for (std::size_t i = 0; i < 8; ++i) part_[i] = _mm512_loadu_si512(linear + 32 * i);
    }
    // `at` in 16-bit lanes, 0 to 255.
    [[nodiscard]] HWY_INLINE __m512i operator()(__m512i at) const {
        const __mmask32 upper = _mm512_test_epi16_mask(at, _mm512_set1_epi16(128));
        const __mmask32 odd = _mm512_test_epi16_mask(at, _mm512_set1_epi16(64));
        const __m512i first = _mm512_permutex2var_epi16(part_[0], at, part_[1]);
        const __m512i second = _mm512_permutex2var_epi16(part_[2], at, part_[3]);
        const __m512i third = _mm512_permutex2var_epi16(part_[4], at, part_[5]);
        const __m512i fourth = _mm512_permutex2var_epi16(part_[6], at, part_[7]);
        const __m512i low = _mm512_mask_blend_epi16(odd, first, second);
        const __m512i high = _mm512_mask_blend_epi16(odd, third, fourth);
        return _mm512_mask_blend_epi16(upper, low, high);
    }

private:
    __m512i part_[8];
};

// As many pixels of the row as fill vectors; returns how many.
std::size_t linearise_many(const Rgba8* pixels, std::size_t count, const std::uint16_t* linear, std::uint16_t* out,
                           std::size_t channel_stride) {
    constexpr std::size_t kPixels = 32;
    const ChannelLookup lookup{linear};
    const __m512i byte = _mm512_set1_epi32(0xFF);
    std::size_t x = 0;
    for (; x + kPixels <= count; x += kPixels) {
        const __m512i first = _mm512_loadu_si512(pixels + x);
        const __m512i second = _mm512_loadu_si512(pixels + x + kPixels / 2);
        for (unsigned channel = 0; channel < 3; ++channel) {
            const __m256i low = _mm512_cvtepi32_epi16(_mm512_and_si512(_mm512_srli_epi32(first, 8 * channel), byte));
            const __m256i high = _mm512_cvtepi32_epi16(_mm512_and_si512(_mm512_srli_epi32(second, 8 * channel), byte));
            const __m512i at = _mm512_inserti64x4(_mm512_castsi256_si512(low), high, 1);
            _mm512_storeu_si512(out + channel * channel_stride + x, lookup(at));
        }
    }
    return x;
}

#else

std::size_t linearise_many(const Rgba8*, std::size_t, const std::uint16_t*, std::uint16_t*, std::size_t) { return 0; }

#endif

// 255 becomes kLinearOne exactly. The compiler makes vectors of it.
void scale_alpha(const Rgba8* pixels, std::size_t count, std::uint16_t* out) {
    for (std::size_t x = 0; x < count; ++x) {
        out[x] = static_cast<std::uint16_t>((pixels[x].a * static_cast<unsigned>(kLinearOne) + 127U) / 255U);
    }
}

void linearise_here(const ColourImage& image, const std::array<std::uint16_t, 256>& linear, LinearAlpha alpha,
                    LinearRows rows) {
    const auto width = static_cast<std::size_t>(image.width());
    const auto stride = static_cast<std::size_t>(rows.channel_stride);
    const std::size_t channels = alpha == LinearAlpha::kept ? 4 : 3;
    std::uint16_t* out = rows.first;
    for (int y = 0; y < image.height(); ++y) {
        const Rgba8* row = image.row(y).data();
        const std::size_t done = linearise_many(row, width, linear.data(), out, stride);
        linearise_one_by_one(row + done, width - done, linear.data(), out + done, stride);
        if (alpha == LinearAlpha::kept) scale_alpha(row, width, out + 3 * stride);
        for (std::size_t channel = 0; channel < channels; ++channel) {
            std::fill(out + channel * stride + width, out + (channel + 1) * stride, std::uint16_t{0});
        }
        out += channels * stride;
    }
}

std::uint16_t rounded_mean(unsigned a, unsigned b) { return static_cast<std::uint16_t>((a + b + 1U) / 2U); }

// As many columns as fill vectors, but for the last one; returns how many.
std::size_t average_many(LinearRow row, LinearRow below, std::size_t count, LinearRow pixels, std::uint16_t* nodes) {
#if HWY_TARGET == HWY_SCALAR
    static_cast<void>(row), static_cast<void>(below), static_cast<void>(count), static_cast<void>(pixels);
    static_cast<void>(nodes);
    return 0;
#else
    const hn::ScalableTag<std::uint16_t> d;
    const hn::RepartitionToWide<decltype(d)> pair;
    const hn::Rebind<std::uint16_t, decltype(pair)> half;
    const std::size_t lanes = hn::Lanes(d);
    std::size_t x = 0;
    for (; x + lanes < count; x += lanes) {
        const auto channel = [&](std::ptrdiff_t index) LW_INLINE_LAMBDA {
            const std::uint16_t* upper = row.first + index * row.channel_stride + x;
            const std::uint16_t* lower = below.first + index * below.channel_stride + x;
            const auto left = hn::AverageRound(hn::LoadU(d, upper), hn::LoadU(d, lower));
            const auto right = hn::AverageRound(hn::LoadU(d, upper + 1), hn::LoadU(d, lower + 1));
            const auto mean = hn::AverageRound(left, right);
            if (pixels.first == nullptr) return mean;
            const auto at_centres = hn::LoadU(half, pixels.first + index * pixels.channel_stride + x / 2);
            return hn::OddEven(mean, hn::BitCast(d, hn::PromoteTo(pair, at_centres)));
        };
        hn::StoreInterleaved3(channel(0), channel(1), channel(2), d, nodes + 3 * x);
    }
    return x;
#endif
}

void average_quarters_here(LinearRow row, LinearRow below, std::size_t count, LinearRow pixels, std::uint16_t* nodes) {
    for (std::size_t x = average_many(row, below, count, pixels, nodes); x < count; ++x) {
        const std::size_t right = std::min(x + 1, count - 1);
        for (std::ptrdiff_t channel = 0; channel < 3; ++channel) {
            const std::uint16_t* upper = row.first + channel * row.channel_stride;
            const std::uint16_t* lower = below.first + channel * below.channel_stride;
            const std::uint16_t mean =
                rounded_mean(rounded_mean(upper[x], lower[x]), rounded_mean(upper[right], lower[right]));
            const bool is_centre = pixels.first != nullptr && x % 2 == 0;
            nodes[3 * x + static_cast<std::size_t>(channel)] =
                is_centre ? pixels.first[channel * pixels.channel_stride + static_cast<std::ptrdiff_t>(x / 2)] : mean;
        }
    }
}

}  // namespace
}  // namespace lw::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lw {

HWY_EXPORT(linearise_here);
HWY_EXPORT(average_quarters_here);

void linearise(const ColourImage& image, const std::array<std::uint16_t, 256>& linear, LinearAlpha alpha,
               LinearRows out) {
    HWY_DYNAMIC_DISPATCH(linearise_here)(image, linear, alpha, out);
}

void average_quarters(LinearRow row, LinearRow below, std::size_t count, LinearRow pixels, std::uint16_t* nodes) {
    HWY_DYNAMIC_DISPATCH(average_quarters_here)(row, below, count, pixels, nodes);
}

}  // namespace lw
#endif
