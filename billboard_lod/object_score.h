#pragma once
/// Mesh or billboard? (Seed 000, section 3.3.)

#include "billboard_lod/projected_bounds.h"

namespace lw {

/// G_T: objects nearer than this share of the scene's diagonal stay meshes. Metres. An empty scene gives 0. Pure.
[[nodiscard]] double mesh_distance_m(const scene::Bounds& scene_bounds_world, double share);

/// S_O: -1 out of view; 0 to be drawn as a mesh: nearer than `mesh_distance_m`, or not to be projected (the eye is
/// inside its box, or the box crosses the near plane); else (d_1 + d_2) / G_O > 0, large for what is small and far.
/// Pure.
[[nodiscard]] double object_score(const ProjectedBounds& bounds, double mesh_distance_m);

}  // namespace lw
