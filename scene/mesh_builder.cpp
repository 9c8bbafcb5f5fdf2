#include "scene/mesh_builder.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/check.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

double linear_of_srgb8(std::uint32_t value) {
    // Cubic fit of the sRGB curve (error below 0.002): no pow, so the same bits everywhere.
    const double x = static_cast<double>(value) / 255.0;
    return x * (x * (x * 0.305306011 + 0.682171111) + 0.012522878);
}

std::uint8_t byte_of(double unit) { return static_cast<std::uint8_t>(std::clamp(unit, 0.0, 1.0) * 255.0 + 0.5); }

/// Horizontal direction in the plane of `normal`, to the right as seen from its front.
glm::dvec3 tangent_of(const glm::dvec3& normal) {
    const glm::dvec3 right = glm::cross(glm::dvec3{0.0, 1.0, 0.0}, normal);
    const double length2 = glm::dot(right, right);
    return length2 > 1e-6 ? right / std::sqrt(length2) : glm::dvec3{1.0, 0.0, 0.0};
}

/// Area-weighted normal of a polygon (Newell); length twice the area.
glm::dvec3 newell_normal(std::span<const glm::dvec3> corners) {
    glm::dvec3 sum{0.0};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
    }
    return sum;
}

/// Two directions across `along`, right-handed: across[0] x across[1] = along.
std::array<glm::dvec3, 2> directions_across(const glm::dvec3& along, const glm::dvec3& up_hint) {
    glm::dvec3 side = glm::cross(up_hint, along);
    if (glm::dot(side, side) < 1e-8) side = glm::cross(glm::dvec3{0.0, 0.0, -1.0}, along);
    if (glm::dot(side, side) < 1e-8) side = glm::cross(glm::dvec3{1.0, 0.0, 0.0}, along);
    side /= std::sqrt(glm::dot(side, side));
    return {side, glm::cross(along, side)};
}

}  // namespace

Rgba8 tint(std::uint32_t srgb_hex, double scale) {
    return {byte_of(linear_of_srgb8((srgb_hex >> 16) & 255u) * scale),
            byte_of(linear_of_srgb8((srgb_hex >> 8) & 255u) * scale), byte_of(linear_of_srgb8(srgb_hex & 255u) * scale),
            255};
}

glm::dmat4 placement(const glm::dvec3& origin, double turns_about_y) {
    const Direction2 d = direction_of_turns(turns_about_y);
    return {glm::dvec4{d.cosine, 0.0, -d.sine, 0.0}, glm::dvec4{0.0, 1.0, 0.0, 0.0},
            glm::dvec4{d.sine, 0.0, d.cosine, 0.0}, glm::dvec4{origin, 1.0}};
}

void MeshBuilder::use_material(int material, double texture_size_m) {
    for (part_ = 0; part_ < parts_.size(); ++part_) {
        if (parts_[part_].material == material) break;
    }
    if (part_ == parts_.size()) parts_.push_back({material, texture_size_m, {}});
    parts_[part_].texture_size_m = texture_size_m;
}

std::uint32_t MeshBuilder::vertex(const glm::dvec3& position, const glm::dvec3& normal) {
    const glm::dvec3 position_object{object_from_local_ * glm::dvec4{position, 1.0}};
    const glm::dvec3 normal_object{object_from_local_ * glm::dvec4{normal, 0.0}};
    const glm::dvec3 tangent = tangent_of(normal_object);
    const glm::dvec3 bitangent = glm::cross(normal_object, tangent);
    const double repeats_per_m = 1.0 / parts_[part_].texture_size_m;
    return vertex(
        position, normal,
        {glm::dot(position_object, tangent) * repeats_per_m, -glm::dot(position_object, bitangent) * repeats_per_m});
}

std::uint32_t MeshBuilder::vertex(const glm::dvec3& position, const glm::dvec3& normal, const glm::dvec2& uv) {
    const glm::dvec3 normal_object{object_from_local_ * glm::dvec4{normal, 0.0}};
    Vertex out;
    out.position_object = glm::vec3{glm::dvec3{object_from_local_ * glm::dvec4{position, 1.0}}};
    out.normal_object = glm::vec3{normal_object};
    out.tangent_object = glm::vec4{glm::vec3{tangent_of(normal_object)}, 1.0f};
    out.uv = glm::vec2{uv};
    out.colour = colour_;
    vertices_.push_back(out);
    return static_cast<std::uint32_t>(vertices_.size() - 1);
}

void MeshBuilder::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a == b || b == c || c == a) return;
    auto& indices = parts_[part_].indices;
    indices.insert(indices.end(), {a, b, c});
}

void MeshBuilder::polygon(std::span<const glm::dvec3> corners) {
    LW_CHECK(!parts_.empty(), "use_material comes first");
    glm::dvec3 normal = newell_normal(corners);
    const double length = std::sqrt(glm::dot(normal, normal));
    if (length < 1e-10) return;
    normal /= length;
    std::uint32_t first = 0;
    std::uint32_t added = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (corners[i] == corners[(i + 1) % corners.size()]) continue;  // a side without length
        const std::uint32_t index = vertex(corners[i], normal);
        if (added == 0) first = index;
        if (++added > 2) triangle(first, index - 1, index);
    }
}

void MeshBuilder::strip(std::span<const std::uint32_t> left, std::span<const std::uint32_t> right) {
    LW_CHECK(left.size() >= 2 && right.size() >= 2, "a strip lies between two lines");
    const auto share = [&](std::span<const std::uint32_t> line, std::size_t i) {
        const auto place = [&](std::uint32_t index) { return vertices_[index].position_object; };
        return glm::distance(place(line[i]), place(line.front())) /
               glm::distance(place(line.back()), place(line.front()));
    };
    for (std::size_t i = 0, j = 0; i + 1 < left.size() || j + 1 < right.size();) {
        const bool step_right =
            i + 1 == left.size() || (j + 1 < right.size() && share(right, j + 1) <= share(left, i + 1));
        if (step_right) {
            triangle(left[i], right[j], right[j + 1]);
            ++j;
        } else {
            triangle(left[i], right[j], left[i + 1]);
            ++i;
        }
    }
}

void MeshBuilder::box(const glm::dvec3& min, const glm::dvec3& max, unsigned sides) {
    const glm::dvec3& a = min;
    const glm::dvec3& b = max;
    if ((sides & kLeft) != 0) polygon({{a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z}});
    if ((sides & kRight) != 0) polygon({{b.x, a.y, b.z}, {b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}});
    if ((sides & kBottom) != 0) polygon({{a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z}});
    if ((sides & kTop) != 0) polygon({{a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z}, {a.x, b.y, a.z}});
    if ((sides & kBack) != 0) polygon({{b.x, a.y, a.z}, {a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}});
    if ((sides & kFront) != 0) polygon({{a.x, a.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, b.z}, {a.x, b.y, b.z}});
}

void MeshBuilder::beam(const glm::dvec3& from, const glm::dvec3& to, double width_m, double height_m,
                       const glm::dvec3& up) {
    const glm::dvec3 span = to - from;
    const double length = std::sqrt(glm::dot(span, span));
    const auto [side, top] = directions_across(span / length, up);
    const glm::dmat4 outer = object_from_local_;
    const glm::dmat4 local_from_beam{glm::dvec4{side, 0.0}, glm::dvec4{top, 0.0}, glm::dvec4{span / length, 0.0},
                                     glm::dvec4{from, 1.0}};
    object_from_local_ = outer * local_from_beam;
    box({-0.5 * width_m, -0.5 * height_m, 0.0}, {0.5 * width_m, 0.5 * height_m, length});
    object_from_local_ = outer;
}

void MeshBuilder::bar(const glm::dvec3& from, const glm::dvec3& to, double radius_m, int sides) {
    const std::array<glm::dvec3, 2> path{from, to};
    tube(path, radius_m, sides);
}

void MeshBuilder::tube(std::span<const glm::dvec3> path, double radius_m, int sides) {
    std::uint32_t previous_ring = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
        glm::dvec3 along = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
        along /= std::sqrt(glm::dot(along, along));
        const auto across = directions_across(along, {0.0, 1.0, 0.0});
        std::uint32_t ring = 0;
        for (int k = 0; k < sides; ++k) {
            // Half a step round, so that a square bar shows a face and not an edge.
            const Direction2 d = direction_of_turns((k + 0.5) / sides);
            const glm::dvec3 normal = across[0] * d.cosine + across[1] * d.sine;
            const std::uint32_t index = vertex(path[i] + normal * radius_m, normal);
            if (k == 0) ring = index;
        }
        for (int k = 0; i > 0 && k < sides; ++k) {
            const auto a = static_cast<std::uint32_t>(k);
            const auto b = static_cast<std::uint32_t>((k + 1) % sides);
            triangle(previous_ring + a, previous_ring + b, ring + b);
            triangle(previous_ring + a, ring + b, ring + a);
        }
        previous_ring = ring;
    }
}

void MeshBuilder::lathe(const glm::dvec3& base, std::span<const ProfilePoint> profile, int sides, bool sharp) {
    // Normals of the profile's segments in the (radius, height) plane, outward for a profile that goes up.
    std::vector<glm::dvec2> segment_normals;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const glm::dvec2 step{profile[i + 1].radius_m - profile[i].radius_m,
                              profile[i + 1].height_m - profile[i].height_m};
        segment_normals.push_back(glm::dvec2{step.y, -step.x} / std::sqrt(glm::dot(step, step)));
    }
    const auto ring = [&](const ProfilePoint& point, glm::dvec2 normal) {
        normal /= std::sqrt(glm::dot(normal, normal));
        const double repeats_per_m = 1.0 / parts_[part_].texture_size_m;
        const double around = std::max(1.0, std::floor(6.283 * profile[0].radius_m * repeats_per_m + 0.5));
        std::uint32_t first = 0;
        for (int k = 0; k <= sides; ++k) {  // the seam twice, for its texture coordinates
            const Direction2 d = direction_of_turns(static_cast<double>(-k % sides) / sides);
            const std::uint32_t index =
                vertex(base + glm::dvec3{point.radius_m * d.cosine, point.height_m, point.radius_m * d.sine},
                       {normal.x * d.cosine, normal.y, normal.x * d.sine},
                       {around * k / sides, -point.height_m * repeats_per_m});
            if (k == 0) first = index;
        }
        return first;
    };
    const auto smooth_normal = [&](std::size_t i) {
        if (i == 0) return segment_normals.front();
        if (i == segment_normals.size()) return segment_normals.back();
        return segment_normals[i - 1] + segment_normals[i] + glm::dvec2{1e-9, 0.0};
    };
    std::uint32_t lower = sharp ? 0 : ring(profile[0], smooth_normal(0));
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        if (sharp) lower = ring(profile[i], segment_normals[i]);
        const std::uint32_t upper = ring(profile[i + 1], sharp ? segment_normals[i] : smooth_normal(i + 1));
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(sides); ++k) {
            if (profile[i].radius_m > 0.0) triangle(lower + k, lower + k + 1, upper + k + 1);
            if (profile[i + 1].radius_m > 0.0) triangle(lower + k, upper + k + 1, upper + k);
        }
        lower = upper;
    }
}

void MeshBuilder::wheel(const glm::dvec3& face, double radius_m, double width_m, int sides) {
    const double out = width_m > 0.0 ? 1.0 : -1.0;
    const glm::dmat4 outer = object_from_local_;
    // Local +y of the lathe becomes outward.
    const glm::dmat4 turned{glm::dvec4{0.0, -out, 0.0, 0.0}, glm::dvec4{out, 0.0, 0.0, 0.0},
                            glm::dvec4{0.0, 0.0, 1.0, 0.0}, glm::dvec4{face, 1.0}};
    object_from_local_ = outer * turned;
    lathe({0.0, 0.0, 0.0}, {{radius_m, -out * width_m}, {radius_m, 0.0}, {0.0, 0.0}}, sides, true);
    object_from_local_ = outer;
}

void MeshBuilder::darken_towards_ground(double strength, double reach_m) {
    for (Vertex& v : vertices_) {
        const double height = std::clamp(static_cast<double>(v.position_object.y) / reach_m, 0.0, 1.0);
        const double keep = 1.0 - strength * (1.0 - height) * (1.0 - height);
        v.colour = {byte_of(v.colour.r / 255.0 * keep), byte_of(v.colour.g / 255.0 * keep),
                    byte_of(v.colour.b / 255.0 * keep), v.colour.a};
    }
}

std::size_t MeshBuilder::triangle_count() const {
    std::size_t indices = 0;
    for (const Part& part : parts_) indices += part.indices.size();
    return indices / 3;
}

Mesh MeshBuilder::take() {
    std::stable_sort(parts_.begin(), parts_.end(),
                     [](const Part& a, const Part& b) { return a.material < b.material; });
    Mesh mesh;
    mesh.name = std::move(name_);
    mesh.vertices = std::move(vertices_);
    for (const Part& part : parts_) {
        if (part.indices.empty()) continue;
        mesh.primitives.push_back({static_cast<std::uint32_t>(mesh.indices.size()),
                                   static_cast<std::uint32_t>(part.indices.size()), part.material});
        mesh.indices.insert(mesh.indices.end(), part.indices.begin(), part.indices.end());
    }
    for (const Vertex& v : mesh.vertices) mesh.bounds.include(glm::dvec3{v.position_object});
    return mesh;
}

}  // namespace lw::scene
