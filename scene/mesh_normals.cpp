#include "scene/mesh_normals.h"

#include <cmath>

namespace lw::scene {
namespace {

// Below this a normal's direction is noise: float positions of a metre-sized model carry 6e-8 m.
constexpr double kShortest = 1e-20;

glm::dvec3 position_of(const Vertex& vertex) { return glm::dvec3{vertex.position_object}; }

/// Twice the area times the unit normal of a counter-clockwise triangle.
glm::dvec3 area_normal(const Vertex& a, const Vertex& b, const Vertex& c) {
    return glm::cross(position_of(b) - position_of(a), position_of(c) - position_of(a));
}

glm::vec3 unit_or_up(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    return length > kShortest ? glm::vec3{direction / length} : glm::vec3{0.0f, 1.0f, 0.0f};
}

bool is_direction(const glm::vec3& v) {
    const float length2 = glm::dot(v, v);
    return std::isfinite(length2) && length2 > 1e-12f;
}

glm::vec3 any_orthogonal(const glm::vec3& normal) {
    const glm::vec3 axis = std::abs(normal.x) < 0.7f ? glm::vec3{1.0f, 0.0f, 0.0f} : glm::vec3{0.0f, 0.0f, 1.0f};
    return glm::normalize(axis - normal * glm::dot(axis, normal));
}

/// Direction of growing u and of growing v over a triangle, weighted by its area; zero where uv has no area.
struct TextureDirections {
    glm::dvec3 along_u{0.0};
    glm::dvec3 along_v{0.0};
};

TextureDirections texture_directions(const Vertex& a, const Vertex& b, const Vertex& c) {
    const glm::dvec3 edge_1 = position_of(b) - position_of(a);
    const glm::dvec3 edge_2 = position_of(c) - position_of(a);
    const glm::dvec2 uv_1 = glm::dvec2{b.uv} - glm::dvec2{a.uv};
    const glm::dvec2 uv_2 = glm::dvec2{c.uv} - glm::dvec2{a.uv};
    const double uv_area = uv_1.x * uv_2.y - uv_2.x * uv_1.y;
    const double area = glm::length(glm::cross(edge_1, edge_2));
    if (!(std::abs(uv_area) > 0.0) || !(area > 0.0)) return {};
    // Only the sign of the texture area matters for the direction: dividing by its size would let slivers win.
    const double sign = uv_area > 0.0 ? 1.0 : -1.0;
    const glm::dvec3 u = sign * (uv_2.y * edge_1 - uv_1.y * edge_2);
    const glm::dvec3 v = sign * (uv_1.x * edge_2 - uv_2.x * edge_1);
    const double length_u = glm::length(u);
    const double length_v = glm::length(v);
    if (!(length_u > 0.0) || !(length_v > 0.0)) return {};
    return {u * (area / length_u), v * (area / length_v)};
}

}  // namespace

void make_flat(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& indices) {
    std::vector<Vertex> corners;
    corners.reserve(indices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        Vertex a = vertices[indices[i]];
        Vertex b = vertices[indices[i + 1]];
        Vertex c = vertices[indices[i + 2]];
        const glm::vec3 normal = unit_or_up(area_normal(a, b, c));
        a.normal_object = b.normal_object = c.normal_object = normal;
        corners.insert(corners.end(), {a, b, c});
    }
    vertices = std::move(corners);
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
}

std::size_t mend_normals(std::span<Vertex> vertices, std::span<const std::uint32_t> indices) {
    std::vector<std::uint32_t> broken;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::vec3& normal = vertices[i].normal_object;
        if (is_direction(normal)) {
            normal = glm::normalize(normal);
        } else {
            broken.push_back(static_cast<std::uint32_t>(i));
        }
    }
    if (broken.empty()) return 0;
    std::vector<glm::dvec3> sums(vertices.size(), glm::dvec3{0.0});
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::dvec3 normal = area_normal(vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]);
        for (std::size_t k = 0; k < 3; ++k) sums[indices[i + k]] += normal;
    }
    for (const std::uint32_t vertex : broken) vertices[vertex].normal_object = unit_or_up(sums[vertex]);
    return broken.size();
}

void make_tangents(std::span<Vertex> vertices, std::span<const std::uint32_t> indices) {
    std::vector<TextureDirections> sums(vertices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const TextureDirections directions =
            texture_directions(vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]);
        for (std::size_t k = 0; k < 3; ++k) {
            sums[indices[i + k]].along_u += directions.along_u;
            sums[indices[i + k]].along_v += directions.along_v;
        }
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const glm::dvec3 normal{vertices[i].normal_object};
        const glm::dvec3 u = sums[i].along_u - normal * glm::dot(normal, sums[i].along_u);
        const double length = glm::length(u);
        const glm::vec3 tangent =
            length > kShortest ? glm::vec3{u / length} : any_orthogonal(vertices[i].normal_object);
        // glTF: bitangent = cross(normal, tangent) * w, and it points along +V of the stored texture coordinates,
        // whose v grows downwards in the image; a normal map's green channel points against it (up in the image).
        const double towards_v = glm::dot(glm::cross(normal, glm::dvec3{tangent}), sums[i].along_v);
        vertices[i].tangent_object = glm::vec4{tangent, towards_v > 0.0 ? -1.0f : 1.0f};
    }
}

void mend_tangents(std::span<Vertex> vertices) {
    for (Vertex& vertex : vertices) {
        const glm::vec3 tangent{vertex.tangent_object};
        const float sign = vertex.tangent_object.w < 0.0f ? -1.0f : 1.0f;
        const glm::vec3 unit = is_direction(tangent) ? glm::normalize(tangent) : any_orthogonal(vertex.normal_object);
        vertex.tangent_object = glm::vec4{unit, sign};
    }
}

}  // namespace lw::scene
