#pragma once
/// Compressed geometry: EXT_meshopt_compression (buffer views) and KHR_draco_mesh_compression (primitives).

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_source.h"

namespace lw::scene {

[[nodiscard]] bool is_meshopt_compressed(const tinygltf::BufferView& view);

/// The decompressed bytes of such a view; decoded once. Every argument is checked before the decoder sees it, because
/// it ends the process on bad ones.
[[nodiscard]] std::span<const std::uint8_t> meshopt_view_bytes(GltfSource& source, int view);

/// A Draco primitive after decoding: triangles and, per attribute name, floats without gaps.
struct DracoPrimitive {
    struct Attribute {
        int components = 0;
        std::vector<float> values;
    };
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> indices;  ///< a triangle list
    std::map<std::string, Attribute> attributes;
};

[[nodiscard]] bool is_draco_compressed(const tinygltf::Primitive& primitive);

/// @param place  of the primitive, "meshes[0].primitives[1]"
/// The caller charges nothing: decoded data is charged and released here, so at most one primitive is alive at a time.
[[nodiscard]] DracoPrimitive decode_draco(GltfSource& source, const tinygltf::Primitive& primitive,
                                          const std::string& place);

}  // namespace lw::scene
