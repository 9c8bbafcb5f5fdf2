#pragma once
/// Colours in linear light as whole numbers, and back: what bilinear reads of whole pictures need to be fast.

#include <array>
#include <bit>
#include <cstdint>
#include <memory>

#include "core/image.h"

namespace lw {

/// 1.0 of linear light. 15 bits tell the darkest sRGB steps apart ten times over.
inline constexpr int kLinearOne = 32767;

enum class LinearAlpha : std::uint8_t { none, kept };

/// A picture in linear light, 15 bits per channel in 16. Channels lie apart, so that one vector holds a stretch of one
/// channel; the three rows of one image row follow each other, and a fourth with alpha where that is wanted. Beyond the
/// last column and the last row lie zeros, so that a read of kSpareColumns pixels from any pixel on, in its row and the
/// kSpareRows below, stays inside.
class LinearImage {
public:
    static constexpr std::ptrdiff_t kSpareColumns = 32;  ///< 16-bit lanes of the widest vector
    static constexpr std::ptrdiff_t kSpareRows = 4;

    LinearImage() = default;
    /// Any thread. Alpha is kept as it is, in steps of kLinearOne / 255.
    explicit LinearImage(const ColourImage& image, LinearAlpha alpha = LinearAlpha::none);

    [[nodiscard]] glm::ivec2 size_px() const { return size_px_; }
    /// From a pixel's red to its green, from its green to its blue, from its blue to its alpha.
    [[nodiscard]] std::ptrdiff_t channel_stride() const { return channel_stride_; }
    [[nodiscard]] std::ptrdiff_t row_stride() const { return channels_ * channel_stride_; }
    [[nodiscard]] bool has_alpha() const { return channels_ == 4; }
    /// Of channel 0 (red), 1 or 2.
    [[nodiscard]] std::uint16_t* row(int y, int channel) {
        return values_.get() + y * row_stride() + channel * channel_stride_;
    }
    [[nodiscard]] const std::uint16_t* row(int y, int channel) const {
        return values_.get() + y * row_stride() + channel * channel_stride_;
    }
    /// Of images that have one.
    [[nodiscard]] std::uint16_t* alpha_row(int y) { return values_.get() + y * row_stride() + 3 * channel_stride_; }
    /// Red of the first pixel.
    [[nodiscard]] const std::uint16_t* data() const { return values_.get(); }

private:
    glm::ivec2 size_px_{0};
    std::ptrdiff_t channels_ = 3;
    std::ptrdiff_t channel_stride_ = 0;
    std::unique_ptr<std::uint16_t[]> values_;
};

/// sRGB encoding of 15-bit linear light as one parabola per half octave of `value + 1`: entry 2 e + m holds for sums
/// from (2 + m) 2^(e - 1) on. Vectors look the coefficients up and evaluate them, which is faster than a table of all
/// values. Within 0.1 of an 8-bit step of the exact curve, so LinearImage and this give every stored colour back.
struct SrgbParabolas {
    alignas(64) std::array<float, 32> constant{};
    alignas(64) std::array<float, 32> first{};
    alignas(64) std::array<float, 32> second{};
};
/// Built once, thread safe.
[[nodiscard]] const SrgbParabolas& srgb_parabolas();

/// Adding this to a float in [0, 2^22] leaves the nearest whole number in its lowest bits.
inline constexpr float kRoundingOffset = 8388608.0F;

/// The 8-bit value of `linear15` in [0, kLinearOne]; the scalar twin of what vectors compute, equal to the bit.
[[nodiscard]] inline std::uint8_t srgb8_from_linear15(std::int32_t linear15, const SrgbParabolas& parabolas) {
    const float value = static_cast<float>(linear15) + 1.0F;
    const std::size_t entry = (std::bit_cast<std::uint32_t>(value) >> 22U) - 254U;
    const float encoded =
        (parabolas.second[entry] * value + parabolas.first[entry]) * value + parabolas.constant[entry];
    return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(encoded + kRoundingOffset));
}

/// srgb8_from_linear15 of every value, for reads one by one. Built once, thread safe.
[[nodiscard]] const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table();

}  // namespace lw
