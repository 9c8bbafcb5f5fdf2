#pragma once
/// Which of several source samples a target pixel shows. One integer holds the whole rule, so its order is total and
/// the picture does not depend on the order of writes or threads.

#include <algorithm>
#include <bit>
#include <cstdint>

namespace lw {

/// The larger key wins; 0 is "no sample". From the top bit down:
///   15 bits  depth step: nearer wins; steps of 0.4 %, so that neighbours on one surface do not fight over noise,
///    8 bits  closeness of the projected place to the pixel centre, 1 (far) to 255,
///   15 bits  rest of the depth,
///   26 bits  source pixel index.
/// A tolerance instead of steps ("within 0.4 %") would be cyclic: A beats B beats C beats A.
using WinnerKey = std::uint64_t;

inline constexpr int kWinnerIndexBits = 26;
/// Largest number of source pixels a key can tell apart: 8192 x 8192.
inline constexpr std::int64_t kMaxKeyedPixels = std::int64_t{1} << kWinnerIndexBits;

/// @param depth         target depth in [0, 1]
/// @param distance2_px  squared distance of the projected place from the pixel centre, px^2; told apart up to 4
/// @param source_index  below kMaxKeyedPixels
[[nodiscard]] inline WinnerKey winner_key(float depth, float distance2_px, std::uint32_t source_index) {
    const auto depth_bits = std::bit_cast<std::uint32_t>(depth);
    const auto farness = static_cast<std::uint32_t>(std::min(254.0F, distance2_px * 63.5F));
    const std::uint64_t step = depth_bits >> 15U;
    const std::uint64_t rest = depth_bits & 0x7FFFU;
    return (step << 49U) | (std::uint64_t{255U - farness} << 41U) | (rest << 26U) | source_index;
}

[[nodiscard]] inline float winner_depth(WinnerKey key) {
    const auto step = static_cast<std::uint32_t>(key >> 49U);
    const auto rest = static_cast<std::uint32_t>(key >> 26U) & 0x7FFFU;
    return std::bit_cast<float>((step << 15U) | rest);
}

[[nodiscard]] inline std::uint32_t winner_source_index(WinnerKey key) {
    return static_cast<std::uint32_t>(key) & ((1U << kWinnerIndexBits) - 1U);
}

}  // namespace lw
