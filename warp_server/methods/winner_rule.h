#pragma once
/// Which of several source samples a target pixel shows. One integer holds the whole rule, so its order is total and
/// the picture does not depend on the order of writes or threads.

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/image.h"

namespace lw {

/// The larger key wins; 0 is "no sample". From the top bit down:
///   15 bits  depth step: nearer wins; steps of 0.4 %, so that neighbours on one surface do not fight over noise,
///    8 bits  closeness of the projected place to the pixel centre, 1 (far) to 255,
///   15 bits  rest of the depth,
///    2 bits  0,
///   24 bits  the sample's colour: what the pixel will show, so that nobody has to look it up again, and samples that
///            tie in everything else tie only when they look the same.
/// A tolerance instead of steps ("within 0.4 %") would be cyclic: A beats B beats C beats A.
using WinnerKey = std::uint64_t;

/// Closeness is told apart up to this squared distance from the pixel centre, px^2, in 254 equal steps.
inline constexpr float kFarthestTold2_px = 4.0F;

/// Closeness is read off the upper eight bits of the mantissa of a float between 1 and 2, which is this at the centre,
/// falls by the second with every px^2, and never below the third. Vectors have no cheaper way from float to integer.
inline constexpr float kClosestMantissa = 2.0F - 1.0F / 256.0F;
inline constexpr float kMantissaPerPx2 = 254.0F / 256.0F / kFarthestTold2_px;
inline constexpr float kFarthestMantissa = 1.0F + 1.0F / 256.0F;
inline constexpr int kMantissaShift = 15;

/// @param depth         target depth in [0, 1]
/// @param distance2_px  squared distance of the projected place from the pixel centre, px^2
[[nodiscard]] inline WinnerKey winner_key(float depth, float distance2_px, Rgba8 colour) {
    const auto depth_bits = std::bit_cast<std::uint32_t>(depth);
    const float mantissa = std::max(kClosestMantissa - distance2_px * kMantissaPerPx2, kFarthestMantissa);
    const std::uint64_t closeness = std::bit_cast<std::uint32_t>(mantissa) >> kMantissaShift & 0xFFU;
    const std::uint64_t step = depth_bits >> 15U;
    const std::uint64_t rest = depth_bits & 0x7FFFU;
    return (step << 49U) | (closeness << 41U) | (rest << 26U) | (std::uint64_t{colour.b} << 16U) |
           (std::uint64_t{colour.g} << 8U) | colour.r;
}

[[nodiscard]] inline float winner_depth(WinnerKey key) {
    const auto step = static_cast<std::uint32_t>(key >> 49U);
    const auto rest = static_cast<std::uint32_t>(key >> 26U) & 0x7FFFU;
    return std::bit_cast<float>((step << 15U) | rest);
}

/// Opaque: a display has no alpha.
[[nodiscard]] inline Rgba8 winner_colour(WinnerKey key) {
    return {static_cast<std::uint8_t>(key), static_cast<std::uint8_t>(key >> 8U), static_cast<std::uint8_t>(key >> 16U),
            255};
}

}  // namespace lw
