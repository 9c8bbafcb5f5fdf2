#pragma once
/// Pixels of each object in a layer, counted once per rendered frame: what cannot be used is known then, too.

#include <cstdint>
#include <span>
#include <vector>

#include "core/object_transform.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/methods/object_matrices.h"

namespace lw {

/// Pixels of one object id in a layer.
struct IdCount {
    ObjectId id = 0;
    std::uint64_t pixels = 0;
    std::uint64_t bad_depths = 0;
};

/// By ascending id, those that occur. Any thread.
[[nodiscard]] std::vector<IdCount> count_ids(const CpuPixels& pixels);

/// The pixels that cannot be drawn with these matrices.
[[nodiscard]] WarpCounters bad_pixels(std::span<const IdCount> counts, const ObjectMatrices& matrices);

}  // namespace lw
