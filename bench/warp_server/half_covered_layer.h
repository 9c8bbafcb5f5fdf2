#pragma once
/// The picture that the warp is timed on: half of it covered, a thousand movers in it.

#include <cstdint>

#include "frame_link/rendered_frame.h"

namespace lw::bench {

/// Sky above, ground to the horizon below, with boxes standing on it as movers 1..`movers` in a regular pattern; each
/// box is one plane facing the camera with edges to the ground. Half of the pixels are background. Deterministic.
[[nodiscard]] Layer half_covered_layer(glm::ivec2 size_px, int movers);

/// Adds quarters (CpuPixels::quarters) that look like their pixels.
[[nodiscard]] Layer with_quarters(Layer layer);

/// A head that moved 2 cm and turned by 1.2 degrees, what a 100 ms old frame has to make up for.
[[nodiscard]] Camera moved_head(const Camera& source);

/// The layer's movers 3 cm further to the right.
[[nodiscard]] std::vector<ObjectTransform> moved_objects(const Layer& layer);

}  // namespace lw::bench
