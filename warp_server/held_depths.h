#pragma once
/// Depths of pixels that must stay as they are while others are drawn over (StackBase::picture); compiled for every
/// instruction set and chosen at run time.

#include <cstddef>

namespace lw {

/// Above every depth.
inline constexpr float kHeldDepth = 2.0F;

/// Those of `depths` that are not below `farthest` become kHeldDepth.
void hold_depths(float* depths, std::size_t count, float farthest);

/// Those that are held become what they were.
void release_depths(float* depths, const float* before, std::size_t count);

}  // namespace lw
