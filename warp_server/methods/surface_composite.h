#pragma once
/// Putting together the surfaces that meet in one pixel, for many pixels at once; compiled for every instruction set
/// and chosen at run time, the same bytes on all.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image.h"
#include "warp_server/methods/surface_fragments.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Lists of fragments per pixel, and what is behind them.
struct FragmentLists {
    std::span<const SurfaceFragment> fragments;
    std::int32_t* newest;  ///< of each pixel: its first fragment, whose link leads on; reset to -1 when it is done
    float* depths;         ///< of what is opaque, negative where nothing is
    Rgba8* colours;
    std::uint32_t first_pixel;                   ///< number in the picture of the first of these
    std::vector<PartlyCovered>* partly_covered;  ///< pixels are appended
};

/// A pixel of which this share is covered counts as covered wholly: the rest changes no 8-bit colour.
inline constexpr float kWholeCover = 1.0F - 1.0F / 256.0F;

/// Pixels with more fragments go one by one.
inline constexpr int kMostFragmentsAtOnce = 4;

/// Composites the pixels `touched`: nearest first, each over what is behind it; the farthest surface takes what is left
/// where nothing is opaque, because the surfaces of one place fill it together. A pixel of which less than half is
/// covered stays as it is. Those with more than kMostFragmentsAtOnce are left alone and moved to the front of
/// `touched`.
/// @return how many were left
[[nodiscard]] std::size_t composite_fragments(const FragmentLists& lists, std::span<std::uint32_t> touched);

}  // namespace lw
