#pragma once
/// Why a shown pixel differs from the truth: what the renderer never drew, or what became of what it drew.

#include <cstdint>

#include "core/image.h"
#include "core/surface_match.h"

namespace lw {

/// The cause of whatever error a pixel of the truth has.
enum class ErrorCause : std::uint8_t {
    resampled,      ///< the source shows its surface: what remains is sampling, of the source and by the warp
    disoccluded,    ///< the source has its place, but something else hid it there
    out_of_frame,   ///< its place lies outside of the source picture
    stale_shading,  ///< the source shows its surface, in another light
};

/// One cause per pixel of the truth. A pixel's surface is the one at its centre. Shading is stale where, over the 5x5
/// pixels around, those of one surface have in the source (read bilinearly on that surface) another mean colour than in
/// the truth: by more than 2 of 255 and more than four standard errors, so that aliasing, which scatters, is not taken
/// for it. At least 8 pixels must agree on the surface; else the pixel counts as resampled.
/// @param truth         the scene at photon time, one sample per pixel, with its colours
/// @param source        what the warp was given
/// @param threads       0 means as many as the machine has
[[nodiscard]] Image<ErrorCause> error_causes(const SampledView& truth, const ColourImage& truth_colour,
                                             const SampledView& source, const ColourImage& source_colour, int threads);

/// Parts of a mean error, each over all pixels of the picture: their sum is the mean of the map.
struct AttributedError {
    double resampled = 0.0;
    double disoccluded = 0.0;
    double out_of_frame = 0.0;
    double stale_shading = 0.0;

    [[nodiscard]] double sum() const { return resampled + disoccluded + out_of_frame + stale_shading; }
};

/// @param error_map  per pixel, as of flip(); of the size of `causes`. Pure, any thread.
[[nodiscard]] AttributedError attribute_error(const Image<float>& error_map, const Image<ErrorCause>& causes);

/// Share of the pixels with each cause, in [0, 1]. Pure, any thread.
[[nodiscard]] AttributedError shares_of(const Image<ErrorCause>& causes);

}  // namespace lw
