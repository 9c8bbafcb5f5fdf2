#include <algorithm>
#include <cstring>
#include <limits>

#include "scene/gltf_writer.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;

/// One buffer view with one attribute of all vertices of a mesh.
struct Stream {
    const char* name = "";
    const char* type = "";
    int component_type = kFloat;
    std::size_t element_bytes = 0;
    int view = kNone;
};

template <class Element, class Get>
Stream write_stream(const Mesh& mesh, const char* name, const char* type, int component_type, const Get& get,
                    GltfWriter& writer) {
    std::vector<Element> elements;
    elements.reserve(mesh.vertices.size());
    for (const Vertex& vertex : mesh.vertices) elements.push_back(get(vertex));
    const int view = writer.add_view(std::as_bytes(std::span{elements}), sizeof(Element));
    return {name, type, component_type, sizeof(Element), view};
}

template <class Differs>
bool any_vertex(const Mesh& mesh, const Differs& differs) {
    return std::any_of(mesh.vertices.begin(), mesh.vertices.end(), differs);
}

/// Attributes at their default everywhere are not written.
std::vector<Stream> write_streams(const Mesh& mesh, GltfWriter& writer) {
    const Vertex standard;
    std::vector<Stream> streams;
    streams.push_back(write_stream<glm::vec3>(
        mesh, "POSITION", "VEC3", kFloat, [](const Vertex& v) { return v.position_object; }, writer));
    streams.push_back(write_stream<glm::vec3>(
        mesh, "NORMAL", "VEC3", kFloat, [](const Vertex& v) { return v.normal_object; }, writer));
    if (any_vertex(mesh, [&](const Vertex& v) { return v.tangent_object != standard.tangent_object; })) {
        streams.push_back(write_stream<glm::vec4>(
            mesh, "TANGENT", "VEC4", kFloat, [](const Vertex& v) { return v.tangent_object; }, writer));
    }
    if (any_vertex(mesh, [&](const Vertex& v) { return v.uv != standard.uv; })) {
        streams.push_back(write_stream<glm::vec2>(
            mesh, "TEXCOORD_0", "VEC2", kFloat, [](const Vertex& v) { return v.uv; }, writer));
    }
    if (any_vertex(mesh, [&](const Vertex& v) { return v.colour != standard.colour; })) {
        streams.push_back(write_stream<Rgba8>(
            mesh, "COLOR_0", "VEC4", kUnsignedByte, [](const Vertex& v) { return v.colour; }, writer));
    }
    return streams;
}

/// Vertices that a primitive uses: [first, first + count).
struct VertexRange {
    std::uint32_t first = 0;
    std::size_t count = 0;
};

std::span<const std::uint32_t> indices_of(const Mesh& mesh, const Primitive& primitive) {
    return std::span{mesh.indices}.subspan(primitive.first_index, primitive.index_count);
}

VertexRange vertex_range(std::span<const std::uint32_t> indices) {
    const auto [smallest, largest] = std::minmax_element(indices.begin(), indices.end());
    return {*smallest, std::size_t{*largest} - *smallest + 1};
}

int write_indices(std::span<const std::uint32_t> indices, const VertexRange& range, GltfWriter& writer) {
    // The largest value of each type is reserved (primitive restart).
    if (range.count <= std::numeric_limits<std::uint16_t>::max()) {
        std::vector<std::uint16_t> shorts;
        shorts.reserve(indices.size());
        for (const std::uint32_t index : indices) shorts.push_back(static_cast<std::uint16_t>(index - range.first));
        return writer.add_accessor(writer.add_view(std::as_bytes(std::span{shorts})), 0, kUnsignedShort, shorts.size(),
                                   "SCALAR");
    }
    std::vector<std::uint32_t> relative;
    relative.reserve(indices.size());
    for (const std::uint32_t index : indices) relative.push_back(index - range.first);
    return writer.add_accessor(writer.add_view(std::as_bytes(std::span{relative})), 0, kUnsignedInt, relative.size(),
                               "SCALAR");
}

/// glTF demands the bounds of positions.
void write_position_bounds(const Mesh& mesh, const VertexRange& range, json& accessor) {
    glm::vec3 low{std::numeric_limits<float>::max()};
    glm::vec3 high{std::numeric_limits<float>::lowest()};
    for (const Vertex& vertex : std::span{mesh.vertices}.subspan(range.first, range.count)) {
        low = glm::min(low, vertex.position_object);
        high = glm::max(high, vertex.position_object);
    }
    accessor["min"] = {low.x, low.y, low.z};
    accessor["max"] = {high.x, high.y, high.z};
}

json primitive_json(const Mesh& mesh, const Primitive& primitive, const std::vector<Stream>& streams,
                    GltfWriter& writer) {
    const std::span<const std::uint32_t> indices = indices_of(mesh, primitive);
    const VertexRange range = vertex_range(indices);
    json object;
    for (const Stream& stream : streams) {
        const int accessor = writer.add_accessor(stream.view, range.first * stream.element_bytes, stream.component_type,
                                                 range.count, stream.type);
        json& written = writer.root["accessors"].back();
        if (stream.component_type == kUnsignedByte) written["normalized"] = true;
        if (std::strcmp(stream.name, "POSITION") == 0) write_position_bounds(mesh, range, written);
        object["attributes"][stream.name] = accessor;
    }
    object["indices"] = write_indices(indices, range, writer);
    if (primitive.material != kNone) object["material"] = primitive.material;
    return object;
}

}  // namespace

std::vector<int> write_meshes(const Scene& scene, GltfWriter& writer) {
    std::vector<int> gltf_mesh(scene.meshes.size(), kNone);
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        const auto draws = [](const Primitive& primitive) { return primitive.index_count > 0; };
        if (std::none_of(mesh.primitives.begin(), mesh.primitives.end(), draws)) continue;
        const std::vector<Stream> streams = write_streams(mesh, writer);
        json object;
        if (!mesh.name.empty()) object["name"] = mesh.name;
        for (const Primitive& primitive : mesh.primitives) {
            if (draws(primitive)) object["primitives"].push_back(primitive_json(mesh, primitive, streams, writer));
        }
        gltf_mesh[i] = writer.add("meshes", std::move(object));
    }
    return gltf_mesh;
}

}  // namespace lw::scene
