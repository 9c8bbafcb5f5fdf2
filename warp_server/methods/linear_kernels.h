#pragma once
/// The loop that makes linear pictures, compiled for every instruction set and chosen at run time.

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/image.h"
#include "warp_server/methods/linear_colour.h"

namespace lw {

/// Where the channels of a row go: its reds, its greens `channel_stride` further on, its blues, and its alphas if they
/// are kept; then the next row.
struct LinearRows {
    std::uint16_t* first = nullptr;
    std::ptrdiff_t channel_stride = 0;
};

/// Looks every colour channel of `image` up in `linear`, and scales alpha to kLinearOne; zeros behind each channel's
/// row up to the stride. Any thread.
void linearise(const ColourImage& image, const std::array<std::uint16_t, 256>& linear, LinearAlpha alpha,
               LinearRows out);

/// One row of an image with three channels.
struct LinearRow {
    const std::uint16_t* first = nullptr;
    std::ptrdiff_t channel_stride = 0;
};

/// Means of 2x2 values: of columns x and x + 1 of `row` and of the row `below` it, a mean of two means, each rounded
/// up. The last column counts twice. Where `pixels` is not null, every second value from the first on becomes the next
/// of `pixels` instead. Any thread.
/// @param count  of columns: at least 1, even
/// @param nodes  `count` times red, green and blue
void average_quarters(LinearRow row, LinearRow below, std::size_t count, LinearRow pixels, std::uint16_t* nodes);

}  // namespace lw
