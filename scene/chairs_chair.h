#pragma once
/// A café chair of bent wood with a cushion.

#include "scene/mesh_builder.h"

namespace lw::scene {

/// Origin on the ground under the seat's middle, the back towards +Z; 0.9 m high. At least 5,000 triangles.
[[nodiscard]] Mesh make_chair(Rgba8 wood, Rgba8 cushion);

}  // namespace lw::scene
