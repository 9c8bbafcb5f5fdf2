#pragma once
/// The bytes a glTF file refers to: its binary chunk, data URIs, and files beside it.

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf_refusal.h"

namespace lw::scene {

/// Bytes that are either owned or a view into the .glb.
struct GltfBytes {
    std::vector<std::uint8_t> owned;
    std::span<const std::uint8_t> view;
};

/// Reads what a `uri` names: base64 data, or a file in `folder` or below it. Refuses other schemes, absolute paths,
/// paths that leave the folder (also through links), what is no regular file, and what passes the budget. The result
/// stays charged.
[[nodiscard]] std::vector<std::uint8_t> read_uri(const std::string& uri, const std::filesystem::path& folder,
                                                 MemoryBudget& budget, const std::string& place);

/// The bytes of `buffers[]` in order, each cut to its byteLength. A buffer without URI is the binary chunk if it is the
/// first one, else empty (a fallback that only compressed views refer to). `buffers` is checked JSON.
[[nodiscard]] std::vector<GltfBytes> read_buffers(const nlohmann::json& buffers, bool has_binary_chunk,
                                                  std::span<const std::uint8_t> binary_chunk,
                                                  const std::filesystem::path& folder, MemoryBudget& budget);

/// Bytes that base64 text stands for; padding may be missing. Refuses other characters.
[[nodiscard]] std::vector<std::uint8_t> decode_base64(std::string_view text, const std::string& place);

}  // namespace lw::scene
