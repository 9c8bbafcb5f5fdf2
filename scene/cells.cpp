#include "scene/cells.h"

#include <algorithm>
#include <cmath>

namespace lw::scene {

namespace {

using Polygon = std::vector<glm::dvec3>;

// Corners closer than this to a plane lie on it; widens what may be seen.
constexpr double kEpsilon_m = 1e-6;

struct Plane {
    glm::dvec3 normal{0.0};
    double offset = 0.0;
    [[nodiscard]] double distance(const glm::dvec3& point) const { return glm::dot(normal, point) - offset; }
};

/// The part of a polygon in front of a plane, or within the epsilon behind it.
Polygon clipped(const Polygon& polygon, const Plane& plane) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
        const double da = plane.distance(a) + kEpsilon_m;
        const double db = plane.distance(b) + kEpsilon_m;
        if (da >= 0.0) kept.push_back(a);
        if ((da < 0.0) != (db < 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
    }
    return kept;
}

/// Which side of a plane a polygon lies on: 1 in front, -1 behind, 0 on both or in it.
int side_of(const Polygon& polygon, const Plane& plane) {
    bool front = false;
    bool behind = false;
    for (const glm::dvec3& corner : polygon) {
        front = front || plane.distance(corner) > kEpsilon_m;
        behind = behind || plane.distance(corner) < -kEpsilon_m;
    }
    return front == behind ? 0 : (front ? 1 : -1);
}

/// Cuts off what no straight line from `first` through `last` reaches: every plane through an edge of the one and a
/// corner of the other that has them on different sides.
void clip_to_lines(const Polygon& first, const Polygon& last, Polygon& beyond) {
    for (std::size_t i = 0; i < first.size() && !beyond.empty(); ++i) {
        const glm::dvec3& a = first[i];
        const glm::dvec3& b = first[(i + 1) % first.size()];
        for (const glm::dvec3& corner : last) {
            const glm::dvec3 normal = glm::cross(b - a, corner - a);
            const double length = glm::length(normal);
            if (length < 1e-9) continue;
            Plane plane{normal / length, glm::dot(normal / length, a)};
            const int first_side = side_of(first, plane);
            const int last_side = side_of(last, plane);
            if (first_side == 0 || last_side == 0 || first_side == last_side) continue;
            // What is beyond `last` is on its side of the plane.
            if (last_side < 0) plane = {-plane.normal, -plane.offset};
            beyond = clipped(beyond, plane);
            if (beyond.empty()) return;
        }
    }
}

Polygon polygon_of(const Portal& portal) { return {portal.corners_world.begin(), portal.corners_world.end()}; }

/// The plane of a portal, with the portal's cell `side` (0 or 1) in front.
Plane plane_towards(const CellGraph& graph, const Portal& portal, std::size_t side) {
    const auto& c = portal.corners_world;
    const glm::dvec3 normal = glm::normalize(glm::cross(c[1] - c[0], c[3] - c[0]));
    const Plane plane{normal, glm::dot(normal, c[0])};
    // The outside has no middle: it is where the other cell is not.
    const bool is_outside = portal.cells[side] == 0;
    const Cell& cell = graph.cells[static_cast<std::size_t>(portal.cells[is_outside ? 1 - side : side])];
    const bool in_front = plane.distance(0.5 * (cell.min_world + cell.max_world)) >= 0.0;
    return in_front != is_outside ? plane : Plane{-plane.normal, -plane.offset};
}

bool reaches_beyond(const Polygon& polygon, const Plane& plane) {
    return std::any_of(polygon.begin(), polygon.end(),
                       [&](const glm::dvec3& corner) { return plane.distance(corner) > kEpsilon_m; });
}

/// Follows all rows of portals from one cell.
class Flow {
public:
    Flow(CellGraph& graph, int from) : graph_{graph}, from_{from}, entered_(graph.cells.size(), false) {}

    void run() {
        mark(from_);
        entered_[index(from_)] = true;
        for (const int first : graph_.cells[index(from_)].portals) {
            const Polygon polygon = polygon_of(graph_.portals[index(first)]);
            enter({other(first, from_), first, polygon, polygon, true});
        }
    }

private:
    struct Way {
        int cell;
        int portal;     ///< that led into the cell
        Polygon first;  ///< what of the first portal a line may come through
        Polygon last;   ///< what of the portal that led into the cell
        bool is_first;  ///< both are the same portal
    };

    static std::size_t index(int i) { return static_cast<std::size_t>(i); }
    [[nodiscard]] std::size_t side_in(int portal, int cell) const {
        return graph_.portals[index(portal)].cells[0] == cell ? 0 : 1;
    }
    [[nodiscard]] int other(int portal, int cell) const {
        return graph_.portals[index(portal)].cells[1 - side_in(portal, cell)];
    }
    void mark(int cell) {
        const std::size_t word = index(from_) * graph_.words_per_cell() + index(cell) / 64;
        graph_.visible[word] |= std::uint64_t{1} << (index(cell) % 64);
    }

    void enter(const Way& way) {
        mark(way.cell);
        entered_[index(way.cell)] = true;
        const Plane entrance = plane_towards(graph_, graph_.portals[index(way.portal)], side_in(way.portal, way.cell));
        for (const int portal : graph_.cells[index(way.cell)].portals) {
            const int next = other(portal, way.cell);
            if (portal == way.portal || entered_[index(next)]) continue;
            Polygon target = clipped(polygon_of(graph_.portals[index(portal)]), entrance);
            if (!reaches_beyond(target, entrance)) continue;
            Polygon source = way.first;
            if (!way.is_first) {
                clip_to_lines(way.first, way.last, target);
                if (target.size() < 3) continue;
                clip_to_lines(target, way.last, source);
                if (source.size() < 3) continue;
            }
            enter({next, portal, source, target, false});
        }
        entered_[index(way.cell)] = false;
    }

    CellGraph& graph_;
    int from_;
    std::vector<bool> entered_;
};

}  // namespace

int CellGraph::cell_at(const glm::dvec3& point_world) const {
    for (std::size_t i = 1; i < cells.size(); ++i) {
        const Cell& cell = cells[i];
        const bool inside = point_world.x >= cell.min_world.x && point_world.x <= cell.max_world.x &&
                            point_world.y >= cell.min_world.y && point_world.y <= cell.max_world.y &&
                            point_world.z >= cell.min_world.z && point_world.z <= cell.max_world.z;
        if (inside) return static_cast<int>(i);
    }
    return 0;
}

void CellGraph::find_visible() {
    visible.assign(cells.size() * words_per_cell(), 0);
    for (int from = 0; from < static_cast<int>(cells.size()); ++from) Flow{*this, from}.run();
}

}  // namespace lw::scene
