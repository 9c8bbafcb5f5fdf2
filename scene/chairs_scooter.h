#pragma once
/// A motor scooter of pressed steel.

#include "scene/mesh_builder.h"

namespace lw::scene {

/// Origin on the ground between the wheels, front towards -Z; 1.75 m long. At least 5,000 triangles.
[[nodiscard]] Mesh make_scooter(Rgba8 paint, Rgba8 saddle);

}  // namespace lw::scene
