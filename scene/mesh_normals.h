#pragma once
/// Normals and tangents where a file brings none, or broken ones.

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// Gives every triangle three vertices of its own with the triangle's normal (glTF 2.0, section 3.7.2.1: flat normals
/// where there are none). `indices` becomes 0, 1, 2, ...; triangles without area get +Y.
void make_flat(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices);

/// Replaces normals that are not finite or too short to have a direction by the area-weighted mean of the triangles
/// around, and makes all others unit vectors.
/// @return how many were replaced
std::size_t mend_normals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

/// Tangents along +U, orthogonal to the normals, from the texture coordinates of the triangles around each vertex;
/// where those have no direction (no area in texture space) any orthogonal vector. Normals are unit vectors.
void make_tangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices);

/// As mend_normals() for tangents: unit and finite, a sign of +1 or -1. Broken ones become any orthogonal vector.
void mend_tangents(std::span<Vertex> vertices);

}  // namespace lw::scene
