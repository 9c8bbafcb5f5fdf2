#pragma once
/// glTF meshes -> Mesh: triangles of every mode, attributes of every format.

#include <cstdint>

#include "scene/gltf_source.h"
#include "scene/scene.h"

namespace lw::scene {

/// What was met in all meshes, for warnings once per kind.
struct MeshFindings {
    std::uint64_t point_and_line_primitives = 0;
    std::uint64_t primitives_without_positions = 0;
    std::uint64_t mended_normals = 0;
};

/// Reads a mesh. Throws GltfRefusal for indices out of range, positions that are not finite, attributes of different
/// length or of the wrong type. Its vertices and indices stay charged.
/// @param materials  of the scene, for what the vertices must carry (tangents)
[[nodiscard]] Mesh import_mesh(GltfSource& source, int mesh, const std::vector<Material>& materials,
                               MeshFindings& findings);

}  // namespace lw::scene
