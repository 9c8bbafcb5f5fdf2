#pragma once
/// A few points around a mesh: where it lies before a camera, closer than its box says.

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.h"

namespace lw {

/// Points whose convex hull holds the mesh: the corners of the boxes around its vertices in each cell of a grid of
/// 4x4x4 over its box. At most 512, and no more than the mesh has vertices; object space, metres. Pure, any thread.
[[nodiscard]] std::vector<glm::dvec3> outline_points(const scene::Mesh& mesh);

}  // namespace lw
