#include <draco/compression/decode.h>

#include <array>

#include "scene/gltf_accessors.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_draco_header.h"

namespace lw::scene {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";
constexpr int kMaxComponents = 4;

// What the decoder was seen to hold per triangle and per vertex while it works: corner table, attribute values.
constexpr std::uint64_t kWorkBytesPerTriangle = 64;
constexpr std::uint64_t kWorkBytesPerVertex = 64;

std::unique_ptr<draco::Mesh> decode(std::span<const std::uint8_t> bytes, const std::string& place) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) refuse("the Draco data is damaged", place);
    return std::move(decoded).value();
}

/// Draco keeps integers as written, so normalised ones are scaled here as the accessor says.
float scale_of(const tinygltf::Accessor& accessor) {
    if (!accessor.normalized) return 1.0f;
    switch (accessor.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return 1.0f / 127.0f;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1.0f / 255.0f;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return 1.0f / 32767.0f;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 1.0f / 65535.0f;
        default:
            return 1.0f;
    }
}

/// The attribute's raw numbers, whatever its type. ConvertValue would scale normalised integers itself, depending on a
/// flag in the compressed data that may disagree with the accessor.
bool raw_value(const draco::PointAttribute& attribute, draco::AttributeValueIndex value, int components,
               std::array<float, kMaxComponents>& numbers) {
    if (!attribute.normalized()) {
        return attribute.ConvertValue<float>(value, static_cast<std::int8_t>(components), numbers.data());
    }
    std::array<std::int32_t, kMaxComponents> integers{};
    if (!attribute.ConvertValue<std::int32_t>(value, static_cast<std::int8_t>(components), integers.data())) {
        return false;
    }
    for (std::size_t i = 0; i < integers.size(); ++i) numbers[i] = static_cast<float>(integers[i]);
    return true;
}

DracoPrimitive::Attribute read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& attribute, float scale,
                                         const std::string& place) {
    DracoPrimitive::Attribute result;
    result.components = attribute.num_components();
    if (result.components < 1 || result.components > kMaxComponents) refuse("the Draco data is damaged", place);
    result.values.reserve(mesh.num_points() * static_cast<std::size_t>(result.components));
    std::array<float, kMaxComponents> numbers{};
    for (draco::PointIndex point{0}; point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = attribute.mapped_index(point);
        if (value.value() >= attribute.size() || !raw_value(attribute, value, result.components, numbers)) {
            refuse("the Draco data is damaged", place);
        }
        for (int i = 0; i < result.components; ++i) {
            result.values.push_back(numbers[static_cast<std::size_t>(i)] * scale);
        }
    }
    return result;
}

std::vector<std::uint32_t> read_faces(const draco::Mesh& mesh, const std::string& place) {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t{mesh.num_faces()} * 3);
    for (draco::FaceIndex face{0}; face < mesh.num_faces(); ++face) {
        for (const draco::PointIndex& point : mesh.face(face)) {
            if (point.value() >= mesh.num_points()) refuse("the Draco data is damaged", place);
            indices.push_back(point.value());
        }
    }
    return indices;
}

}  // namespace

bool is_draco_compressed(const tinygltf::Primitive& primitive) { return primitive.extensions.count(kExtension) != 0; }

DracoPrimitive decode_draco(GltfSource& source, const tinygltf::Primitive& primitive, const std::string& place) {
    const std::string here = fmt::format("{}.extensions.{}", place, kExtension);
    const tinygltf::Value& extension = primitive.extensions.at(kExtension);
    const std::span<const std::uint8_t> bytes = view_bytes(source, extension.Get("bufferView").GetNumberAsInt());
    const DracoClaims claims = read_draco_claims(bytes, here);
    const TemporaryCharge triangles{source.budget, claims.triangles, kWorkBytesPerTriangle, here};
    const TemporaryCharge vertices{source.budget, claims.vertices, kWorkBytesPerVertex, here};

    const std::unique_ptr<draco::Mesh> mesh = decode(bytes, here);
    DracoPrimitive result;
    result.vertex_count = mesh->num_points();
    result.indices = read_faces(*mesh, here);
    const tinygltf::Value& attributes = extension.Get("attributes");
    for (const std::string& name : attributes.Keys()) {
        const auto accessor = primitive.attributes.find(name);
        if (accessor == primitive.attributes.end()) continue;
        const auto* attribute =
            mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(attributes.Get(name).GetNumberAsInt()));
        if (attribute == nullptr) refuse("the Draco data lacks " + name, here);
        // A corrupt byte often still decodes, to another number of vertices.
        if (accessor_count(source, accessor->second) != result.vertex_count) {
            refuse(fmt::format("the Draco data has {} vertices, the accessor of {} claims {}", result.vertex_count,
                               name, accessor_count(source, accessor->second)),
                   here);
        }
        const float scale = scale_of(source.model.accessors[static_cast<std::size_t>(accessor->second)]);
        result.attributes[name] = read_attribute(*mesh, *attribute, scale, here);
    }
    return result;
}

}  // namespace lw::scene
