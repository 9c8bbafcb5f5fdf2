#pragma once
/// What is restless about an error: how much it changes from one display frame to the next, on the surfaces.

#include <optional>

#include "core/image.h"
#include "core/surface_match.h"

namespace lw {

/// Where each pixel's surface was in the display frame before: the index of the pixel closest to its place, -1 where
/// that frame did not show it. Pixels of one still surface keep each other's company whatever the head does, as the eye
/// of a viewer follows them.
/// @param threads  0 means as many as the machine has
[[nodiscard]] Image<int> pixels_before(const SampledView& now, const SampledView& before, int threads);

/// Mean change of the error over the pixels that both frames show: the root mean square over R, G and B of
/// (shown - truth) now less (shown - truth) before, sRGB values in [0, 1]; 0 for an error that rests on its surface,
/// at most 2. Nothing where no pixel was shown before. All images of one size. Pure, any thread.
[[nodiscard]] std::optional<double> flicker(const ColourImage& truth_now, const ColourImage& shown_now,
                                            const ColourImage& truth_before, const ColourImage& shown_before,
                                            const Image<int>& pixels_before);

}  // namespace lw
