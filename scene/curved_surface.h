#pragma once
/// Smooth sheets through a grid of points: what MeshBuilder's solids cannot shape.

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/mesh_builder.h"

namespace lw::scene {

/// Adds the sheet through `points`: `columns` >= 2 points per row, at least two rows, row after row. Fronts are
/// counter- clockwise when columns run to the right and rows run up. `closed` joins the last column to the first.
/// Normals are those of the surface; rows that shrink to a point take the direction of their neighbours.
void add_sheet(MeshBuilder& builder, std::span<const glm::dvec3> points, int columns, bool closed);

/// A closed cross-section of `sides` points about `centre`: a rounded rectangle in the plane of `across` and `up`, both
/// unit. `roundness` 0 is a rectangle, 1 an ellipse.
[[nodiscard]] std::vector<glm::dvec3> rounded_section(const glm::dvec3& centre, const glm::dvec3& across,
                                                      const glm::dvec3& up, double half_width_m, double half_height_m,
                                                      double roundness, int sides);

/// A point of the smooth curve (Catmull-Rom, uniform) through `points`, at least two; `t` in [0, 1] over the whole.
[[nodiscard]] glm::dvec3 on_curve(std::span<const glm::dvec3> points, double t);

/// `count` >= 2 places along that curve.
[[nodiscard]] std::vector<glm::dvec3> curve(std::span<const glm::dvec3> points, int count);

}  // namespace lw::scene
