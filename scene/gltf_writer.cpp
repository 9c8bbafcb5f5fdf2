#include "scene/gltf_writer.h"

#include <cstring>
#include <limits>

namespace lw::scene {
namespace {

void append_u32(std::vector<std::byte>& bytes, std::size_t number) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<std::byte>(number >> shift & 0xFF));
}

void append_chunk(std::vector<std::byte>& file, std::uint32_t type, std::span<const std::byte> bytes, std::byte pad) {
    const std::size_t padded = (bytes.size() + 3) / 4 * 4;
    append_u32(file, padded);
    append_u32(file, type);
    file.insert(file.end(), bytes.begin(), bytes.end());
    file.insert(file.end(), padded - bytes.size(), pad);
}

}  // namespace

int GltfWriter::add_view(std::span<const std::byte> bytes, std::size_t stride) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}};
    if (stride != 0) view["byteStride"] = stride;
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

int GltfWriter::add_accessor(int view, std::size_t byte_offset, int component_type, std::size_t count,
                             const char* type) {
    nlohmann::json accessor = {
        {"bufferView", view}, {"componentType", component_type}, {"count", count}, {"type", type}};
    if (byte_offset != 0) accessor["byteOffset"] = byte_offset;
    return add("accessors", std::move(accessor));
}

int GltfWriter::add(const char* array_name, nlohmann::json object) {
    nlohmann::json& array = root[array_name];
    array.push_back(std::move(object));
    return static_cast<int>(array.size()) - 1;
}

std::vector<std::byte> GltfWriter::finish() {
    constexpr std::uint32_t kMagicGltf = 0x46546C67;    // "glTF"
    constexpr std::uint32_t kChunkJson = 0x4E4F534A;    // "JSON"
    constexpr std::uint32_t kChunkBinary = 0x004E4942;  // "BIN"
    if (!extensions_.empty()) root["extensionsUsed"] = extensions_;
    if (!binary_.empty()) root["buffers"] = nlohmann::json::array({{{"byteLength", binary_.size()}}});
    // Names may hold bytes that are no UTF-8; they are replaced rather than failing the whole file.
    const std::string text = root.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::size_t total =
        12 + 8 + (text.size() + 3) / 4 * 4 + (binary_.empty() ? 0 : 8 + (binary_.size() + 3) / 4 * 4);
    if (total > std::numeric_limits<std::uint32_t>::max()) return {};
    std::vector<std::byte> file;
    file.reserve(total);
    append_u32(file, kMagicGltf);
    append_u32(file, 2);
    append_u32(file, total);
    append_chunk(file, kChunkJson, std::as_bytes(std::span{text}), std::byte{' '});
    if (!binary_.empty()) append_chunk(file, kChunkBinary, binary_, std::byte{0});
    return file;
}

}  // namespace lw::scene
