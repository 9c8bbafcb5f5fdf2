#pragma once
/// How well two eyes' pictures agree with each other: what a viewer's brain has to fuse.

#include <cstdint>
#include <optional>

#include "core/image.h"
#include "core/surface_match.h"

namespace lw {

/// One eye's picture beside its truth. All images of one size; they outlive it.
struct ShownEye {
    const SampledView& truth;         ///< the scene at photon time at pixel centres, which finds the pairs
    const ColourImage& truth_colour;  ///< as the errors are measured against
    const ColourImage& shown;
    const Image<std::uint8_t>& invented;  ///< 1 where no source pixel arrived and a fill made the colour up
};

/// Over all pairs of pixels, one in each eye, whose centres' surfaces are the same point of the scene
/// (match_surfaces(), both ways).
struct EyeConsistency {
    /// Mean over the pairs of how much more the two pixels differ than the truth's do: root mean square over R, G and B
    /// of the sRGB values in [0, 1], above the truth's; 0 where they differ less.
    double colour_excess = 0.0;
    /// Share of the pairs of which one pixel was made up and the other seen: the eyes compete.
    double rivalry_fraction = 0.0;
    /// Mean over the parts of the picture of how far the pair is apart vertically beyond the truth's pair, pixels; over
    /// the insides of surfaces in those parts whose texture tells it with a standard error of 0.02 px. Where no part
    /// does, as in small pictures, of the whole picture at once; nothing where that has no texture either.
    std::optional<double> vertical_disparity_px;
};

/// @param threads  0 means as many as the machine has
/// @return nothing when the eyes see nothing in common
[[nodiscard]] std::optional<EyeConsistency> eye_consistency(const ShownEye& left, const ShownEye& right, int threads);

}  // namespace lw
