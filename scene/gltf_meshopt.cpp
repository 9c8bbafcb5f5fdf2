#include <meshoptimizer.h>

#include "scene/gltf_accessors.h"
#include "scene/gltf_compression.h"

namespace lw::scene {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";

/// The extension's properties (checked to be integers and texts by gltf_schema.h).
struct Compressed {
    std::string mode;
    std::string filter;
    std::size_t count = 0;
    std::size_t stride = 0;
    std::span<const std::uint8_t> bytes;
};

std::size_t number_of(const tinygltf::Value& extension, const char* name) {
    return extension.Has(name) ? static_cast<std::size_t>(extension.Get(name).GetNumberAsInt()) : 0;
}

Compressed compressed_of(const GltfSource& source, const tinygltf::BufferView& view, const std::string& place) {
    const tinygltf::Value& extension = view.extensions.at(kExtension);
    Compressed result;
    result.mode = extension.Get("mode").Get<std::string>();
    result.filter = extension.Has("filter") ? extension.Get("filter").Get<std::string>() : "NONE";
    result.count = number_of(extension, "count");
    result.stride = number_of(extension, "byteStride");
    result.bytes = buffer_bytes(source, static_cast<int>(number_of(extension, "buffer")),
                                number_of(extension, "byteOffset"), number_of(extension, "byteLength"), place);
    return result;
}

void check_arguments(const Compressed& from, const std::string& place) {
    if (from.mode == "ATTRIBUTES") {
        if (from.stride == 0 || from.stride % 4 != 0 || from.stride > 256) {
            refuse("the byte stride is not a multiple of 4 up to 256", place + ".byteStride");
        }
    } else if (from.mode == "TRIANGLES" || from.mode == "INDICES") {
        if (from.stride != 2 && from.stride != 4) refuse("an index has 2 or 4 bytes", place + ".byteStride");
        if (from.mode == "TRIANGLES" && from.count % 3 != 0) {
            refuse("the count is not a multiple of 3", place + ".count");
        }
        if (from.filter != "NONE") refuse("indices have no filter", place + ".filter");
    } else {
        refuse("unknown mode", place + ".mode");
    }
    const bool filter_fits =
        from.filter == "NONE" || (from.filter == "OCTAHEDRAL" && (from.stride == 4 || from.stride == 8)) ||
        (from.filter == "QUATERNION" && from.stride == 8) || (from.filter == "EXPONENTIAL" && from.stride % 4 == 0);
    if (!filter_fits) refuse("unknown filter, or not for this byte stride", place + ".filter");
}

std::vector<std::uint8_t> decode(const Compressed& from, const std::string& place) {
    std::vector<std::uint8_t> decoded(from.count * from.stride);
    if (from.count == 0) return decoded;
    int result = 0;
    if (from.mode == "ATTRIBUTES") {
        result =
            meshopt_decodeVertexBuffer(decoded.data(), from.count, from.stride, from.bytes.data(), from.bytes.size());
    } else if (from.mode == "TRIANGLES") {
        result =
            meshopt_decodeIndexBuffer(decoded.data(), from.count, from.stride, from.bytes.data(), from.bytes.size());
    } else {
        result =
            meshopt_decodeIndexSequence(decoded.data(), from.count, from.stride, from.bytes.data(), from.bytes.size());
    }
    if (result != 0) refuse("the compressed data is damaged", place);
    if (from.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(decoded.data(), from.count, from.stride);
    if (from.filter == "QUATERNION") meshopt_decodeFilterQuat(decoded.data(), from.count, from.stride);
    if (from.filter == "EXPONENTIAL") meshopt_decodeFilterExp(decoded.data(), from.count, from.stride);
    return decoded;
}

}  // namespace

bool is_meshopt_compressed(const tinygltf::BufferView& view) { return view.extensions.count(kExtension) != 0; }

std::span<const std::uint8_t> meshopt_view_bytes(GltfSource& source, int view) {
    const auto known = source.decoded_views.find(view);
    if (known != source.decoded_views.end()) return known->second;
    const std::string place = fmt::format("bufferViews[{}].extensions.{}", view, kExtension);
    const Compressed from = compressed_of(source, source.model.bufferViews[static_cast<std::size_t>(view)], place);
    check_arguments(from, place);
    source.budget.charge(from.count, from.stride, place);
    return source.decoded_views.emplace(view, decode(from, place)).first->second;
}

}  // namespace lw::scene
