#pragma once
/// From keys to pixels: the second half of `splat`, compiled for every instruction set and chosen at run time. Every
/// one gives the same bytes.

#include <glm/glm.hpp>

#include "warp_server/methods/key_ring.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/splat_input.h"
#include "warp_server/pixel_rect.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Where the background comes from: a target pixel that no point reached shows the source pixel in its direction when
/// that one is background.
struct BackgroundLookup {
    glm::mat3 source_px_from_target_px{1.0F};  ///< homography of the rotation, columns x, y, 1
};

/// Turns the keys of `target_rows` into colour, depth and coverage of the ring's columns, and leaves those keys 0.
void resolve_rows(const SplatInput& input, const BackgroundLookup& background, RowRange target_rows, KeyRing& keys,
                  DisplayFrame& out);

/// The same for pixels that no point has reached: background or holes.
void resolve_unreached(const SplatInput& input, const BackgroundLookup& background, const PixelRect& target,
                       DisplayFrame& out);

}  // namespace lw
