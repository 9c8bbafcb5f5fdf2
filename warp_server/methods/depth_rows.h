#pragma once
/// What rows of target depths say, on vectors of every instruction set, chosen at run time. Pure, any thread.

#include <cstddef>

#include "warp_server/warp_method.h"

namespace lw {

/// How many of the depths are below `limit`.
[[nodiscard]] std::size_t count_below(const float* depths, std::size_t count, float limit);

/// Reached where a depth is 0 or more, a hole where it is negative.
void mark_coverage(const float* depths, std::size_t count, Coverage* coverage);

}  // namespace lw
