#include "scene/gltf_document.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr std::uint32_t kMagicGltf = 0x46546C67;    // "glTF"
constexpr std::uint32_t kChunkJson = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kChunkBinary = 0x004E4942;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t little_endian_u32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return static_cast<std::uint32_t>(bytes[offset]) | static_cast<std::uint32_t>(bytes[offset + 1]) << 8 |
           static_cast<std::uint32_t>(bytes[offset + 2]) << 16 | static_cast<std::uint32_t>(bytes[offset + 3]) << 24;
}

/// Memory of the tree stays charged as `document.json`.
void parse_json(std::span<const std::uint8_t> text, MemoryBudget& budget, GltfDocument& document) {
    if (text.empty()) refuse("the file holds no JSON", "");
    // The parser collects a string before it hands it over; its buffer may have doubled.
    const TemporaryCharge longest_string{budget, text.size(), 2, ""};
    document.json = json_cost(text, kMaxJsonDepth, budget.left_bytes());
    budget.charge(document.json.bytes(), "");
    try {
        document.root = json::parse(text.begin(), text.end());
    } catch (const json::exception&) {
        refuse("broken JSON", "");  // json_cost() has seen the same text and found no fault
    }
    if (!document.root.is_object()) refuse("the JSON is not an object", "");
}

/// The chunk at `offset`; moves `offset` behind it.
struct Chunk {
    std::uint32_t type = 0;
    std::span<const std::uint8_t> bytes;
};

Chunk take_chunk(std::span<const std::uint8_t> glb, std::size_t& offset) {
    if (glb.size() - offset < kChunkHeaderBytes) refuse("a chunk header is cut off", "");
    const std::size_t length = little_endian_u32(glb, offset);
    const std::uint32_t type = little_endian_u32(glb, offset + 4);
    offset += kChunkHeaderBytes;
    if (length > glb.size() - offset) {
        refuse(fmt::format("a chunk claims {} bytes where {} are left", length, glb.size() - offset), "");
    }
    const Chunk chunk{type, glb.subspan(offset, length)};
    offset += length;
    return chunk;
}

GltfDocument parse_glb(std::vector<std::uint8_t> bytes, MemoryBudget& budget) {
    GltfDocument document;
    document.file = std::move(bytes);
    if (document.file.size() < kHeaderBytes) refuse("the GLB header is cut off", "");
    const std::uint32_t version = little_endian_u32(document.file, 4);
    const std::size_t length = little_endian_u32(document.file, 8);
    if (version != 2) refuse(fmt::format("GLB version {} is not 2", version), "", "convert the model to glTF 2.0");
    if (length > document.file.size() || length < kHeaderBytes) {
        refuse(fmt::format("the GLB header claims {} bytes, the file has {}", length, document.file.size()), "");
    }
    const auto glb = std::span<const std::uint8_t>{document.file}.first(length);
    std::size_t offset = kHeaderBytes;
    const Chunk text = take_chunk(glb, offset);
    if (text.type != kChunkJson) refuse("the first GLB chunk is not JSON", "");
    // Padding after the last chunk may be shorter than a chunk header.
    while (glb.size() - offset >= kChunkHeaderBytes) {
        const Chunk chunk = take_chunk(glb, offset);
        if (chunk.type != kChunkBinary || document.has_binary_chunk) continue;
        document.has_binary_chunk = true;
        document.binary_chunk = chunk.bytes;
    }
    parse_json(text.bytes, budget, document);
    return document;
}

}  // namespace

GltfDocument parse_gltf_document(std::vector<std::uint8_t> bytes, MemoryBudget& budget) {
    if (bytes.empty()) refuse("the file is empty", "");
    budget.charge(bytes.size(), "");
    if (bytes.size() >= 4 && little_endian_u32(bytes, 0) == kMagicGltf) return parse_glb(std::move(bytes), budget);
    GltfDocument document;
    parse_json(bytes, budget, document);
    budget.release(bytes.size());
    return document;
}

}  // namespace lw::scene
