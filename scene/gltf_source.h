#pragma once
/// A checked glTF file, ready to be read: typed model, the bytes of its buffers, and how much memory is left.

#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "scene/gltf_document.h"
#include "scene/gltf_refusal.h"
#include "scene/gltf_resources.h"

namespace lw::scene {

/// What the readers of meshes, materials, nodes and animations share. One thread.
struct GltfSource {
    std::filesystem::path folder;  ///< files beside the model are looked up here and below
    MemoryBudget budget;
    GltfDocument document;  ///< owns what `buffers` may point into
    nlohmann::json images;  ///< checked; decoded by us, because tinygltf does not check what it hands to its decoder
    tinygltf::Model model;  ///< without buffers, images, cameras and skins
    std::set<int> accessors_without_view;  ///< their bufferView in the model means nothing
    std::vector<GltfBytes> buffers;
    std::map<int, std::vector<std::uint8_t>> decoded_views;  ///< EXT_meshopt_compression, by buffer view
    std::vector<std::string> warnings;                       ///< one line each, once per kind
};

/// Reads and checks `path` up to the typed model. Throws GltfRefusal.
void open_gltf(const std::filesystem::path& path, GltfSource& source);

/// Adds a warning unless the same one is there.
void warn_once(GltfSource& source, const std::string& warning);

}  // namespace lw::scene
