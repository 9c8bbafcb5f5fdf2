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

/// Red, green, blue and 0 in 16 bits each, red lowest, row by row. One more row and a few more pixels than the image,
/// so that reading two by two pixels at the last one stays inside. Any thread.
[[nodiscard]] std::unique_ptr<std::uint64_t[]> linearise(const ColourImage& image);

/// sRGB encoding of 15-bit linear light as one cubic per octave: entry e holds for values from 2^e up to 2^(e + 1),
/// entry 0 for 0 as well. Vectors look the coefficients up and evaluate them, which is faster than a table of all
/// values. Within 0.1 of an 8-bit step of the exact curve, so linearise() and this give every stored colour back.
struct SrgbCubics {
    std::array<float, 16> constant{};
    std::array<float, 16> first{};
    std::array<float, 16> second{};
    std::array<float, 16> third{};
};
/// Built once, thread safe.
[[nodiscard]] const SrgbCubics& srgb_cubics();

/// The 8-bit value of `linear15` in [0, kLinearOne]; the scalar twin of what vectors compute, equal to the bit.
[[nodiscard]] inline std::uint8_t srgb8_from_linear15(std::int32_t linear15, const SrgbCubics& cubics) {
    const auto value = static_cast<float>(linear15);
    const auto octave =
        static_cast<std::size_t>(linear15 < 1 ? 0 : std::bit_width(static_cast<unsigned>(linear15)) - 1);
    const float encoded =
        ((cubics.third[octave] * value + cubics.second[octave]) * value + cubics.first[octave]) * value +
        cubics.constant[octave];
    return static_cast<std::uint8_t>(encoded + 0.5F);
}

/// srgb8_from_linear15 of every value, for reads one by one. Built once, thread safe.
[[nodiscard]] const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table();

}  // namespace lw
