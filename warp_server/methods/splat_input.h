#pragma once
/// What both halves of `splat` read.

#include "frame_link/rendered_frame.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_tiles.h"

namespace lw {

struct SplatInput {
    const CpuPixels* pixels = nullptr;
    const SplatTiles* tiles = nullptr;
    const ObjectMatrices* matrices = nullptr;
};

}  // namespace lw
