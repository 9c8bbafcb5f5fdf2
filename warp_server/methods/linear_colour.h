#pragma once
/// Colours in linear light as whole numbers, and back: what bilinear reads of whole pictures need to be fast.

#include <array>
#include <cstdint>
#include <vector>

#include "core/image.h"

namespace lw {

/// 1.0 of linear light. 15 bits tell the darkest sRGB steps apart ten times over.
inline constexpr int kLinearOne = 32767;

/// Red, green, blue and 0 in 16 bits each, red lowest, row by row. One more row and a few more pixels than the image,
/// so that reading two by two pixels at the last one stays inside. Any thread.
void linearise(const ColourImage& image, std::vector<std::uint64_t>& linear);

/// sRGB values of 0..kLinearOne. linearise() and this give every stored colour back. Built once, thread safe.
[[nodiscard]] const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table();

}  // namespace lw
