#pragma once
/// A glTF file as bytes and JSON: the container is checked, the contents are not (gltf_schema.h does that).

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "scene/gltf_refusal.h"
#include "scene/json_cost.h"

namespace lw::scene {

struct GltfDocument {
    std::vector<std::uint8_t> file;  ///< whole .glb; empty for .gltf, whose text is dropped once it is parsed
    bool has_binary_chunk = false;
    std::span<const std::uint8_t> binary_chunk;  ///< into `file`
    nlohmann::json root;                         ///< an object, at most kMaxJsonDepth deep
    JsonCost json;                               ///< what `root` is charged with
};

/// Deeper nesting is refused: parsers and destructors recurse, and no real glTF file is even 20 deep.
inline constexpr int kMaxJsonDepth = 64;

/// Splits a .glb or takes a .gltf (told apart by their first bytes) and parses the JSON. Refuses what is neither, what
/// is cut off, and what would not fit the budget. Memory of the result stays charged.
[[nodiscard]] GltfDocument parse_gltf_document(std::vector<std::uint8_t> bytes, MemoryBudget& budget);

}  // namespace lw::scene
