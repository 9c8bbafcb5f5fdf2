#pragma once
/// The loop that makes linear pictures, compiled for every instruction set and chosen at run time.

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/image.h"

namespace lw {

/// Looks every channel of `image` up in `linear`: a row's reds to `out`, its greens `channel_stride` further on, then
/// its blues, then the next row; zeros behind each up to `channel_stride`. Any thread.
void linearise(const ColourImage& image, const std::array<std::uint16_t, 256>& linear, std::uint16_t* out,
               std::ptrdiff_t channel_stride);

}  // namespace lw
