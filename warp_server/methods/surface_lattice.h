#pragma once
/// Colours between pixels for `surface`: what a pixel would show whose centre lay half a pixel further.

#include "warp_server/methods/linear_colour.h"

namespace lw {

/// Steps of the lattice from one pixel centre to the next.
inline constexpr int kLatticeSteps = 2;

/// A bilinear read between two pixels shows a mean of two means, which blurs whatever is about a pixel wide. Of pixels
/// whose quarters are known, the mean over the same area anywhere between them is known too: this picture holds it at
/// each pixel's centre, where it is the pixel, and half a pixel to the right, below and both. Where neighbours are of
/// different surfaces what lies between them is of none; nobody reads there.
/// @param linear    of w x h pixels
/// @param quarters  their quarters (CpuPixels), 2w x 2h, becomes the result
/// @return 2w x 2h values without alpha, the first one at the centre of the first pixel
/// Pure, any thread.
[[nodiscard]] LinearImage lattice_between(const LinearImage& linear, LinearImage quarters);

}  // namespace lw
