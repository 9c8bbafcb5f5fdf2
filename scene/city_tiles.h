#pragma once
/// Roof tiles as geometry.

#include "scene/mesh_builder.h"

namespace lw::scene {

/// A slope of overlapping tiles on the plane quad eaves_left, eaves_right, ridge_right, ridge_left (counter-clockwise
/// from outside; eaves and ridge horizontal, left and right as seen from outside). The ridge may be a point.
/// Neighbouring tiles share vertices: 1.3 per triangle.
void add_tiled_slope(MeshBuilder& builder, Rgba8 colour, const glm::dvec3& eaves_left, const glm::dvec3& eaves_right,
                     const glm::dvec3& ridge_right, const glm::dvec3& ridge_left);

}  // namespace lw::scene
