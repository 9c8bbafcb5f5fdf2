#pragma once
/// A .glb under construction: its JSON and its binary chunk. Private to the exporter.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace lw::scene {

/// Keys are written in alphabetic order and numbers in their shortest exact form, so equal scenes give equal bytes.
class GltfWriter {
public:
    nlohmann::json root;

    /// Appends bytes, aligned to 4, as a buffer view; returns its index. `stride` 0: none is written.
    int add_view(std::span<const std::byte> bytes, std::size_t stride = 0);

    /// Appends an accessor and returns its index. `type` is "SCALAR", "VEC3" ...
    int add_accessor(int view, std::size_t byte_offset, int component_type, std::size_t count, const char* type);

    /// Appends an object to a root array and returns its index.
    int add(const char* array_name, nlohmann::json object);

    /// Notes an extension for extensionsUsed.
    void use_extension(const std::string& name) { extensions_.insert(name); }

    /// The finished file; nothing when it passes the 4 GB that a GLB can hold.
    [[nodiscard]] std::vector<std::byte> finish();

private:
    std::vector<std::byte> binary_;
    std::set<std::string> extensions_;
};

/// Writes scene.images, materials, textures and samplers; entry i of "materials" is scene.materials[i]. An image that
/// cannot be encoded or a texture transform with shear is an error.
[[nodiscard]] Status write_materials(const Scene& scene, GltfWriter& writer);

/// Writes scene.meshes; per mesh its index in "meshes", kNone for those without triangles. Every primitive gets the
/// range of vertices it uses.
[[nodiscard]] std::vector<int> write_meshes(const Scene& scene, GltfWriter& writer);

/// Writes nodes with their instances, lights, the start pose as a camera, and the scene. Entry i of "nodes" is
/// scene.nodes[i].
void write_nodes(const Scene& scene, const std::vector<int>& gltf_mesh, GltfWriter& writer);

/// Writes scene.channels, one animation per length.
void write_animations(const Scene& scene, GltfWriter& writer);

}  // namespace lw::scene
