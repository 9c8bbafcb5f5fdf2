#pragma once
/// Image differences as DESIGN-level definitions fix them (docs/conventions.md, "Error"). Images must have equal sizes
/// (programmer error otherwise); alpha is ignored. Pure, any thread.

#include <optional>

#include "core/image.h"

namespace lw {

/// Peak signal-to-noise ratio over the R, G, B sRGB values, dB; nothing when the images are equal.
[[nodiscard]] std::optional<double> psnr_db(const ColourImage& a, const ColourImage& b);

/// Mean structural similarity on luma (BT.601 weights) of the sRGB values scaled to [0, 1]: Gaussian window 11x11,
/// sigma 1.5, K1 = 0.01, K2 = 0.03, data range 1, valid windows only (Wang et al. 2004). Images smaller than the
/// window are compared with the window cut to the image. 1 for equal images.
[[nodiscard]] double ssim(const ColourImage& a, const ColourImage& b);

/// FLIP for low dynamic range images (Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG
/// 2020).
struct FlipResult {
    double mean = 0.0;       ///< in [0, 1]
    Image<float> error_map;  ///< per pixel, [0, 1]
};
/// @param pixels_per_degree  of the display at the image centre, > 0 (core/camera.h), 67 for a desktop monitor
[[nodiscard]] FlipResult flip(const ColourImage& reference, const ColourImage& test, double pixels_per_degree);

}  // namespace lw
