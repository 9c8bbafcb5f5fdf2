#include "apps/alone_in_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lw {

namespace {

/// Corners in pixels and distance: (x_px * distance, y_px * distance, distance).
class Projection {
public:
    explicit Projection(const Camera& camera) : camera_{camera} {
        const glm::dmat3 axes = glm::mat3_cast(camera.world_from_eye.orientation);
        const FovTangents& fov = camera.fov;
        const glm::dvec3 forward = -axes[2];
        x_px_ = (axes[0] - forward * fov.left) * (camera.size_px.x / (fov.right - fov.left));
        y_px_ = (forward * fov.up - axes[1]) * (camera.size_px.y / (fov.up - fov.down));
        forward_ = forward;
    }

    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& position_world) const {
        const glm::dvec3 relative = position_world - camera_.world_from_eye.position_m;
        return {glm::dot(x_px_, relative), glm::dot(y_px_, relative), glm::dot(forward_, relative)};
    }

private:
    const Camera& camera_;
    glm::dvec3 x_px_{0.0};
    glm::dvec3 y_px_{0.0};
    glm::dvec3 forward_{0.0};
};

/// The part of a triangle beyond the near plane: at most four corners.
struct Clipped {
    std::array<glm::dvec2, 4> corners_px{};
    std::size_t count = 0;
};

Clipped clipped(const std::array<glm::dvec3, 3>& triangle, double near_m) {
    Clipped result;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3& a = triangle[i];
        const glm::dvec3& b = triangle[(i + 1) % 3];
        if (a.z >= near_m) result.corners_px[result.count++] = glm::dvec2{a} / a.z;
        if ((a.z >= near_m) == (b.z >= near_m)) continue;
        const glm::dvec3 cut = glm::mix(a, b, (near_m - a.z) / (b.z - a.z));
        result.corners_px[result.count++] = glm::dvec2{cut} / cut.z;
    }
    return result;
}

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Of a convex polygon that turns one way or the other; `front_sign` picks which, 0 takes both.
bool covers_a_pixel(const Clipped& polygon, glm::ivec2 size_px, double front_sign) {
    if (polygon.count < 3) return false;
    glm::dvec2 low{1e300};
    glm::dvec2 high{-1e300};
    double area = 0.0;
    for (std::size_t i = 0; i < polygon.count; ++i) {
        const glm::dvec2& a = polygon.corners_px[i];
        low = glm::min(low, a);
        high = glm::max(high, a);
        area += cross(a - polygon.corners_px[0], polygon.corners_px[(i + 1) % polygon.count] - polygon.corners_px[0]);
    }
    if (area == 0.0 || area * front_sign < 0.0) return false;
    const double sign = area > 0.0 ? 1.0 : -1.0;
    low = glm::clamp(low, glm::dvec2{-1.0}, glm::dvec2{size_px} + 1.0);
    high = glm::clamp(high, glm::dvec2{-1.0}, glm::dvec2{size_px} + 1.0);
    const glm::ivec2 first = glm::max(glm::ivec2{glm::ceil(low - 0.5)}, 0);
    const glm::ivec2 last = glm::min(glm::ivec2{glm::floor(high - 0.5)}, size_px - 1);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            const glm::dvec2 centre{x + 0.5, y + 0.5};
            bool inside = true;
            for (std::size_t i = 0; i < polygon.count && inside; ++i) {
                const glm::dvec2& a = polygon.corners_px[i];
                const glm::dvec2& b = polygon.corners_px[(i + 1) % polygon.count];
                inside = sign * cross(b - a, centre - a) >= 0.0;
            }
            if (inside) return true;
        }
    }
    return false;
}

}  // namespace

bool has_pixel_alone(const scene::Scene& scene, const PlacedInstance& placed, const Camera& camera) {
    const Projection projected{camera};
    const scene::Mesh& mesh = scene.meshes[static_cast<std::size_t>(placed.instance->mesh)];
    std::vector<glm::dvec3> corners;
    corners.reserve(mesh.vertices.size());
    for (const scene::Vertex& vertex : mesh.vertices) {
        corners.push_back(
            projected(glm::dvec3{placed.world_from_object * glm::dvec4{glm::dvec3{vertex.position_object}, 1.0}}));
    }
    for (const scene::Primitive& primitive : mesh.primitives) {
        const bool both_sides = primitive.material != scene::kNone &&
                                scene.materials[static_cast<std::size_t>(primitive.material)].double_sided;
        // Counter-clockwise in space is clockwise where y points down.
        const double front_sign = both_sides ? 0.0 : (placed.mirrored ? 1.0 : -1.0);
        const std::uint32_t end = primitive.first_index + primitive.index_count;
        for (std::uint32_t i = primitive.first_index; i + 2 < end; i += 3) {
            const std::array<glm::dvec3, 3> triangle{corners[mesh.indices[i]], corners[mesh.indices[i + 1]],
                                                     corners[mesh.indices[i + 2]]};
            if (covers_a_pixel(clipped(triangle, camera.near_m), camera.size_px, front_sign)) return true;
        }
    }
    return false;
}

}  // namespace lw
