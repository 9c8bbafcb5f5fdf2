#include "scene/gltf_mesh.h"

#include <cmath>
#include <limits>
#include <optional>

#include "scene/gltf_accessors.h"
#include "scene/gltf_compression.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_triangles.h"
#include "scene/mesh_normals.h"

namespace lw::scene {
namespace {

/// One attribute of a primitive, from an accessor or from Draco data.
struct Attribute {
    int components = 0;
    std::vector<float> values;
};

/// A primitive on its way: where its numbers come from.
class PrimitiveReader {
public:
    PrimitiveReader(GltfSource& source, const tinygltf::Primitive& primitive, std::string place)
        : source_{source}, primitive_{primitive}, place_{std::move(place)} {
        if (is_draco_compressed(primitive)) draco_ = decode_draco(source, primitive, place_);
    }

    [[nodiscard]] std::size_t vertex_count() const {
        return draco_ ? draco_->vertex_count : accessor_count(source_, primitive_.attributes.at("POSITION"));
    }

    /// Nothing when the primitive has no such attribute.
    [[nodiscard]] std::optional<Attribute> attribute(const std::string& name) {
        const auto accessor = primitive_.attributes.find(name);
        if (accessor == primitive_.attributes.end()) return std::nullopt;
        if (draco_) {
            const auto decoded = draco_->attributes.find(name);
            if (decoded != draco_->attributes.end()) {
                return Attribute{decoded->second.components, std::move(decoded->second.values)};
            }
        }
        if (accessor_count(source_, accessor->second) != vertex_count()) {
            refuse(fmt::format("has {} elements, POSITION has {}", accessor_count(source_, accessor->second),
                               vertex_count()),
                   fmt::format("{}.attributes.{}", place_, name));
        }
        const int components = accessor_components(source_, accessor->second);
        return Attribute{components, read_floats(source_, accessor->second, components)};
    }

    /// As attribute(); refuses another number of components.
    [[nodiscard]] std::optional<Attribute> attribute(const std::string& name, int components) {
        std::optional<Attribute> result = attribute(name);
        if (result && result->components != components) {
            refuse(fmt::format("has {} components where {} are needed", result->components, components),
                   fmt::format("{}.attributes.{}", place_, name));
        }
        return result;
    }

    /// A triangle list; every index is inside the vertices.
    [[nodiscard]] std::vector<std::uint32_t> triangles() {
        const std::size_t count = vertex_count();
        if (draco_) return std::move(draco_->indices);
        std::vector<std::uint32_t> corners;
        if (primitive_.indices >= 0) {
            corners = read_indices(source_, primitive_.indices);
        } else {
            corners.resize(count);
            for (std::size_t i = 0; i < count; ++i) corners[i] = static_cast<std::uint32_t>(i);
        }
        for (const std::uint32_t corner : corners) {
            if (corner >= count) {
                refuse(fmt::format("vertex {} does not exist, there are {}", corner, count), place_ + ".indices");
            }
        }
        return triangle_list(primitive_.mode, std::move(corners));
    }

    /// Most triangles that triangles() can return.
    [[nodiscard]] std::size_t max_triangles() const {
        if (draco_) return draco_->indices.size() / 3;
        const std::size_t corners =
            primitive_.indices >= 0 ? accessor_count(source_, primitive_.indices) : vertex_count();
        return primitive_.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
    }

    [[nodiscard]] const std::string& place() const { return place_; }

private:
    GltfSource& source_;
    const tinygltf::Primitive& primitive_;
    std::string place_;
    std::optional<DracoPrimitive> draco_;
};

std::vector<Vertex> read_positions(PrimitiveReader& reader) {
    const Attribute positions = *reader.attribute("POSITION", 3);
    std::vector<Vertex> vertices(reader.vertex_count());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const float* p = &positions.values[3 * i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
            refuse(fmt::format("position {} is not a finite number", i), reader.place() + ".attributes.POSITION");
        }
        vertices[i].position_object = {p[0], p[1], p[2]};
    }
    return vertices;
}

float finite_or_zero(float value) { return std::isfinite(value) ? value : 0.0f; }

void read_texture_coordinates(PrimitiveReader& reader, int uv_set, std::vector<Vertex>& vertices) {
    const std::optional<Attribute> uv = reader.attribute(fmt::format("TEXCOORD_{}", uv_set), 2);
    if (!uv) return;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i].uv = {finite_or_zero(uv->values[2 * i]), finite_or_zero(uv->values[2 * i + 1])};
    }
}

std::uint8_t byte_of(float value) {
    const float clamped = value > 0.0f ? std::min(value, 1.0f) : 0.0f;  // NaN becomes 0
    return static_cast<std::uint8_t>(std::lround(clamped * 255.0f));
}

void read_colours(PrimitiveReader& reader, std::vector<Vertex>& vertices) {
    const std::optional<Attribute> colours = reader.attribute("COLOR_0");
    if (!colours) return;
    if (colours->components != 3 && colours->components != 4) {
        refuse("a colour has 3 or 4 components", reader.place() + ".attributes.COLOR_0");
    }
    const auto step = static_cast<std::size_t>(colours->components);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const float* c = &colours->values[step * i];
        vertices[i].colour = {byte_of(c[0]), byte_of(c[1]), byte_of(c[2]),
                              step == 4 ? byte_of(c[3]) : std::uint8_t{255}};
    }
}

/// Normals from the file, mended, or flat ones; tangents if the material has a normal map.
void read_directions(PrimitiveReader& reader, bool needs_tangents, std::vector<Vertex>& vertices,
                     std::vector<std::uint32_t>& indices, MeshFindings& findings) {
    const std::optional<Attribute> normals = reader.attribute("NORMAL", 3);
    const std::optional<Attribute> tangents = normals ? reader.attribute("TANGENT", 4) : std::optional<Attribute>{};
    if (normals) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const float* n = &normals->values[3 * i];
            vertices[i].normal_object = {n[0], n[1], n[2]};
        }
        findings.mended_normals += mend_normals(vertices, indices);
    } else {
        make_flat(vertices, indices);  // tangents of a file without normals mean nothing (glTF 2.0, 3.7.2.1)
    }
    if (tangents) {
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const float* t = &tangents->values[4 * i];
            vertices[i].tangent_object = {t[0], t[1], t[2], t[3]};
        }
        mend_tangents(vertices);
    } else if (needs_tangents) {
        make_tangents(vertices, indices);
    }
}

/// Exporters let all primitives of a mesh refer to one set of vertices; each keeps its own part.
void drop_unused(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(vertices.size(), kUnused);
    for (const std::uint32_t index : indices) new_index[index] = 0;
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (new_index[i] == kUnused) continue;
        vertices[kept] = vertices[i];
        new_index[i] = kept++;
    }
    if (kept == vertices.size()) return;
    vertices.resize(kept);
    for (std::uint32_t& index : indices) index = new_index[index];
}

void append(const std::vector<Vertex>& vertices, const std::vector<std::uint32_t>& indices, int material, Mesh& mesh) {
    const auto first_vertex = static_cast<std::uint32_t>(mesh.vertices.size());
    Primitive primitive;
    primitive.first_index = static_cast<std::uint32_t>(mesh.indices.size());
    primitive.index_count = static_cast<std::uint32_t>(indices.size());
    primitive.material = material;
    mesh.vertices.insert(mesh.vertices.end(), vertices.begin(), vertices.end());
    for (const std::uint32_t index : indices) mesh.indices.push_back(first_vertex + index);
    mesh.primitives.push_back(primitive);
}

void import_primitive(GltfSource& source, const tinygltf::Primitive& primitive, const std::string& place,
                      const std::vector<Material>& materials, MeshFindings& findings, Mesh& mesh) {
    if (primitive.attributes.count("POSITION") == 0) {
        ++findings.primitives_without_positions;
        return;
    }
    if (!draws_triangles(primitive.mode, place + ".mode")) {
        ++findings.point_and_line_primitives;
        return;
    }
    PrimitiveReader reader{source, primitive, place};
    const bool has_normals = primitive.attributes.count("NORMAL") != 0;
    const std::size_t corners = 3 * reader.max_triangles();
    const std::size_t vertex_count = has_normals ? reader.vertex_count() : std::max(reader.vertex_count(), corners);
    // Besides what the mesh keeps: this primitive's own copy, and its vertices before they are split into corners.
    const TemporaryCharge work_vertices{source.budget, vertex_count, 2 * sizeof(Vertex), place};
    const TemporaryCharge work_indices{source.budget, corners, 2 * sizeof(std::uint32_t), place};

    std::vector<Vertex> vertices = read_positions(reader);
    std::vector<std::uint32_t> indices = reader.triangles();
    if (indices.empty()) return;
    read_texture_coordinates(reader, uv_set_of(source, primitive.material), vertices);
    read_colours(reader, vertices);
    const bool needs_tangents = primitive.material >= 0 &&
                                materials[static_cast<std::size_t>(primitive.material)].normal_texture.image != kNone;
    read_directions(reader, needs_tangents, vertices, indices, findings);
    drop_unused(vertices, indices);
    source.budget.charge(vertices.size(), sizeof(Vertex), place);
    source.budget.charge(indices.size(), sizeof(std::uint32_t), place);
    append(vertices, indices, primitive.material, mesh);
}

}  // namespace

Mesh import_mesh(GltfSource& source, int mesh_index, const std::vector<Material>& materials, MeshFindings& findings) {
    const tinygltf::Mesh& from = source.model.meshes[static_cast<std::size_t>(mesh_index)];
    Mesh mesh;
    mesh.name = from.name;
    for (std::size_t i = 0; i < from.primitives.size(); ++i) {
        import_primitive(source, from.primitives[i], fmt::format("meshes[{}].primitives[{}]", mesh_index, i), materials,
                         findings, mesh);
    }
    return mesh;
}

}  // namespace lw::scene
