#include "scene/solid_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/cell_grid.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr std::size_t kMostBoxes = 3;
// A smaller box than this share of the mesh's own hides too little to be worth its time.
constexpr double kSmallestShare = 0.01;
// A box of this share is taken without looking whether one more side being open gives a larger one.
constexpr double kEnoughShare = 0.06;
constexpr int kRaysPerSide = 64;

using Triangle = std::array<glm::dvec3, 3>;

struct OpaqueSurface {
    std::vector<Triangle> triangles;
    std::vector<bool> double_sided;
    Bounds bounds;
};

OpaqueSurface opaque_surface(const Mesh& mesh, const std::vector<Material>& materials) {
    OpaqueSurface surface;
    for (const Primitive& primitive : mesh.primitives) {
        const Material* material =
            primitive.material == kNone ? nullptr : &materials[static_cast<std::size_t>(primitive.material)];
        if (material != nullptr && material->alpha_cutoff) continue;
        for (std::uint32_t i = primitive.first_index; i + 2 < primitive.first_index + primitive.index_count; i += 3) {
            Triangle triangle;
            for (std::uint32_t k = 0; k < 3; ++k) {
                triangle[k] = mesh.vertices[mesh.indices[i + k]].position_object;
                surface.bounds.include(triangle[k]);
            }
            surface.triangles.push_back(triangle);
            surface.double_sided.push_back(material != nullptr && material->double_sided);
        }
    }
    return surface;
}

/// The part of a convex polygon on the side of an axis-aligned plane where sign * (p[axis] - place) >= 0.
void clip(std::vector<glm::dvec3>& polygon, int axis, double place, double sign) {
    std::vector<glm::dvec3> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
        const double da = sign * (a[axis] - place);
        const double db = sign * (b[axis] - place);
        if (da >= 0.0) kept.push_back(a);
        if ((da < 0.0) != (db < 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    polygon = std::move(kept);
}

/// Moves one side of the box outwards to where the first triangle stands in its way, by `reach` at most.
void grow(Bounds& box, int axis, bool upwards, double reach, const OpaqueSurface& surface) {
    const double sign = upwards ? 1.0 : -1.0;
    const double start = upwards ? box.max[axis] : box.min[axis];
    double free = reach;
    std::vector<glm::dvec3> polygon;
    for (const Triangle& triangle : surface.triangles) {
        const glm::dvec3 low = glm::min(triangle[0], glm::min(triangle[1], triangle[2]));
        const glm::dvec3 high = glm::max(triangle[0], glm::max(triangle[1], triangle[2]));
        bool beside = sign > 0.0 ? high[axis] < start : low[axis] > start;
        for (int other = 0; other < 3; ++other) {
            beside = beside || (other != axis && (high[other] <= box.min[other] || low[other] >= box.max[other]));
        }
        if (beside) continue;
        polygon.assign(triangle.begin(), triangle.end());
        clip(polygon, axis, start, sign);
        for (int other = 0; other < 3 && !polygon.empty(); ++other) {
            if (other == axis) continue;
            // What only touches the side's edge does not stand in its way.
            const double margin = 1e-9 + 1e-6 * (box.max[other] - box.min[other]);
            clip(polygon, other, box.min[other] + margin, 1.0);
            if (!polygon.empty()) clip(polygon, other, box.max[other] - margin, -1.0);
        }
        for (const glm::dvec3& corner : polygon) free = std::min(free, sign * (corner[axis] - start));
    }
    // An open side has nothing in the way.
    const double end = upwards ? surface.bounds.max[axis] : surface.bounds.min[axis];
    free = std::clamp(free, 0.0, std::max(sign * (end - start), 0.0));
    (upwards ? box.max : box.min)[axis] = start + sign * free;
}

/// Triangles that lie at least partly beyond a side's plane: only those can be met by rays from that side.
std::vector<std::size_t> beyond(const Bounds& box, int side, const OpaqueSurface& surface) {
    const int axis = side / 2;
    std::vector<std::size_t> triangles;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const Triangle& t = surface.triangles[i];
        const bool is_beyond = side % 2 == 1 ? std::max({t[0][axis], t[1][axis], t[2][axis]}) >= box.max[axis] - 1e-9
                                             : std::min({t[0][axis], t[1][axis], t[2][axis]}) <= box.min[axis] + 1e-9;
        if (is_beyond) triangles.push_back(i);
    }
    return triangles;
}

/// True when the ray meets a triangle that is drawn as seen from the ray's far end.
bool leaves_through_surface(const glm::dvec3& origin, const glm::dvec3& direction, const OpaqueSurface& surface,
                            const std::vector<std::size_t>& triangles) {
    for (const std::size_t i : triangles) {
        const Triangle& t = surface.triangles[i];
        const glm::dvec3 ab = t[1] - t[0];
        const glm::dvec3 ac = t[2] - t[0];
        const glm::dvec3 p = glm::cross(direction, ac);
        const double det = glm::dot(ab, p);
        // Positive: the ray comes from the front side; it leaves through fronts that are seen from outside.
        if (det == 0.0 || (det > 0.0 && !surface.double_sided[i])) continue;
        const glm::dvec3 from = origin - t[0];
        const double u = glm::dot(from, p) / det;
        if (u < -1e-9 || u > 1.0 + 1e-9) continue;
        const glm::dvec3 q = glm::cross(from, ab);
        const double v = glm::dot(direction, q) / det;
        if (v < -1e-9 || u + v > 1.0 + 1e-9) continue;
        if (glm::dot(ac, q) / det > -1e-9) return true;
    }
    return false;
}

/// Rays from the side into its outer half space; those that end beyond the mesh's open side are left out, since no eye
/// may be there.
bool side_is_closed(const Bounds& box, int side, unsigned open_sides, const OpaqueSurface& surface) {
    const int axis = side / 2;
    const double sign = side % 2 == 1 ? 1.0 : -1.0;
    const glm::dvec3 size = box.max - box.min;
    const double far = 4.0 * glm::length(surface.bounds.half_size());
    const std::vector<std::size_t> triangles = beyond(box, side, surface);
    Random random{4711, static_cast<std::uint64_t>(side)};
    for (int ray = 0; ray < kRaysPerSide; ++ray) {
        glm::dvec3 origin = box.min + size * glm::dvec3{random.between(0.001, 0.999), random.between(0.001, 0.999),
                                                        random.between(0.001, 0.999)};
        origin[axis] = sign > 0.0 ? box.max[axis] : box.min[axis];
        glm::dvec3 direction{random.between(-1.0, 1.0), random.between(-1.0, 1.0), random.between(-1.0, 1.0)};
        // Half of them nearly straight out, half in all directions.
        direction[axis] = sign * (ray % 2 == 0 ? 2.0 : 0.02 + std::abs(direction[axis]));
        direction = glm::normalize(direction);
        const glm::dvec3 end = origin + direction * far;
        bool allowed = true;
        for (int other = 0; other < 6; ++other) {
            if ((open_sides >> other & 1U) == 0) continue;
            const double limit = other % 2 == 1 ? surface.bounds.max[other / 2] : surface.bounds.min[other / 2];
            if (other % 2 == 1 ? end[other / 2] > limit : end[other / 2] < limit) allowed = false;
        }
        if (allowed && !leaves_through_surface(origin, direction, surface, triangles)) return false;
    }
    return true;
}

std::optional<SolidBox> grown_and_checked(const CellGrid& grid, const CellBox& cells, unsigned open_sides,
                                          const OpaqueSurface& surface) {
    SolidBox solid{grid.bounds_of(cells), open_sides};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool upwards : {false, true}) {
            grow(solid.box_object, axis, upwards, 1.5 * grid.cell_size()[axis], surface);
        }
    }
    for (int side = 0; side < 6; ++side) {
        if ((open_sides >> side & 1U) != 0) continue;
        if (!side_is_closed(solid.box_object, side, open_sides, surface)) solid.open_sides |= 1U << side;
    }
    // With fewer than three closed sides there is hardly an eye from which it hides anything.
    int open = 0;
    for (int side = 0; side < 6; ++side) open += static_cast<int>(solid.open_sides >> side & 1U);
    if (open > 3) return std::nullopt;
    return solid;
}

}  // namespace

std::vector<SolidBox> solid_boxes(const Mesh& mesh, const std::vector<Material>& materials) {
    const OpaqueSurface surface = opaque_surface(mesh, materials);
    std::vector<SolidBox> found;
    if (surface.triangles.size() < 4) return found;
    const glm::dvec3 size = surface.bounds.max - surface.bounds.min;
    if (std::min({size.x, size.y, size.z}) < 1e-4 * std::max({size.x, size.y, size.z})) return found;

    CellGrid grid{surface.bounds};
    for (const Triangle& triangle : surface.triangles) grid.mark(triangle);
    // Closed all around; else without a floor, or whichever one side is missing.
    constexpr std::array<unsigned, 7> kOpenSides{0U, 1U << 2, 1U << 0, 1U << 1, 1U << 3, 1U << 4, 1U << 5};
    double best = 0.0;
    for (const unsigned open_sides : kOpenSides) {
        grid.find_solid(open_sides);
        std::vector<SolidBox> boxes;
        double largest = 0.0;
        while (boxes.size() < kMostBoxes) {
            const double least = std::max(kSmallestShare * CellGrid::cell_count(), boxes.empty() ? best : 0.0);
            if (grid.solid_count() < least) break;
            const CellBox cells = grid.take_largest_solid_box();
            if (cells.count() < least) break;
            const auto solid = grown_and_checked(grid, cells, open_sides, surface);
            if (!solid) break;
            boxes.push_back(*solid);
            largest = std::max(largest, cells.count());
        }
        if (largest > best) {
            best = largest;
            found = std::move(boxes);
        }
        if (best > kEnoughShare * CellGrid::cell_count()) break;
    }
    return found;
}

}  // namespace lw::scene
