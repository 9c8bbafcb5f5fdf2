#pragma once
/// The error figures of one shown picture, as every report gives them.

#include <optional>

#include "core/error_attribution.h"
#include "core/image.h"

namespace lw {

struct ImageErrors {
    double flip = 0.0;
    double ssim = 1.0;
    std::optional<double> psnr_db;    ///< nothing for a picture equal to the truth
    double hole_fraction = 0.0;       ///< unreached pixels before fill, counted by the warp
    AttributedError attribution{};    ///< of FLIP, whose sum it is; zero where causes are not known
    std::optional<double> flicker{};  ///< against the display frame before; nothing for the first
    std::optional<double>
        ssim_to_same{};            ///< against `fresh-same` instead of the truth; nothing where it was not asked
    double behind_fraction = 0.0;  ///< pixels that show what lies behind the surface that belongs there
};

/// FLIP, SSIM and PSNR of `shown` against `truth` (equal sizes); the hole fraction stays 0, flicker empty. Pure, any
/// thread.
/// @param pixels_per_degree  of the display at the image centre (core/camera.h)
/// @param causes             of the error of each pixel, or null
[[nodiscard]] ImageErrors errors_against(const ColourImage& truth, const ColourImage& shown, double pixels_per_degree,
                                         const Image<ErrorCause>* causes = nullptr);

}  // namespace lw
