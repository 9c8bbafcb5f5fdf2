#include "client_renderer/portal_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace lw {

namespace {

// Walls are thinner than this: a point farther than that from every cell is out of doors.
constexpr double kThickestWall_m = 0.5;

scene::Bounds bounds_of(const scene::Cell& cell) { return {cell.min_world, cell.max_world}; }

double distance_m(const glm::dvec3& point, const scene::Bounds& box) {
    return glm::distance(point, glm::clamp(point, box.min, box.max));
}

/// How far inside the box the point is, 0 on its surface, negative outside.
double depth_in_m(const glm::dvec3& point, const scene::Bounds& box) {
    const glm::dvec3 depth = glm::min(point - box.min, box.max - point);
    return std::min({depth.x, depth.y, depth.z});
}

struct PortalFrame {
    glm::dvec3 centre{0.0};
    glm::dvec3 u{0.0};  ///< unit, along the first edge
    glm::dvec3 v{0.0};
    glm::dvec3 normal{0.0};
    double half_u = 0.0;
    double half_v = 0.0;
};

/// Exact for rectangles, which the portals of buildings are.
PortalFrame frame_of(const scene::Portal& portal) {
    const auto& c = portal.corners_world;
    PortalFrame frame;
    frame.centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
    const glm::dvec3 edge_u = c[1] - c[0];
    const glm::dvec3 edge_v = c[3] - c[0];
    frame.half_u = 0.5 * glm::length(edge_u);
    frame.half_v = 0.5 * glm::length(edge_v);
    frame.u = edge_u / (2.0 * frame.half_u);
    frame.v = edge_v / (2.0 * frame.half_v);
    frame.normal = glm::normalize(glm::cross(edge_u, edge_v));
    return frame;
}

double distance_m(const glm::dvec3& point, const PortalFrame& frame) {
    const glm::dvec3 to = point - frame.centre;
    const double beside_u = std::max(std::abs(glm::dot(to, frame.u)) - frame.half_u, 0.0);
    const double beside_v = std::max(std::abs(glm::dot(to, frame.v)) - frame.half_v, 0.0);
    const double off = glm::dot(to, frame.normal);
    return std::sqrt(beside_u * beside_u + beside_v * beside_v + off * off);
}

}  // namespace

void PortalWalk::Rect::include(const Rect& other) {
    left = std::min(left, other.left);
    right = std::max(right, other.right);
    down = std::min(down, other.down);
    up = std::max(up, other.up);
}

PortalWalk::PortalWalk(const PlacedInstances& placed)
    : placed_{placed}, graph_{scene::cells_of(placed.scene())}, taken_in_(placed.size(), 0) {
    if (graph_.empty()) return;
    const scene::Instance* first = placed.scene().instances.data();
    std::vector<std::uint32_t> placed_of(placed.size());
    for (std::uint32_t i = 0; i < placed.size(); ++i) {
        placed_of[static_cast<std::size_t>(placed[i].instance - first)] = i;
    }
    objects_.resize(graph_.cells.size());
    for (std::size_t cell = 0; cell < graph_.cells.size(); ++cell) {
        for (const std::uint32_t instance : graph_.cells[cell].instances) objects_[cell].push_back(placed_of[instance]);
    }
    rects_.resize(graph_.cells.size());
}

std::vector<int> PortalWalk::first_cells(const Camera& camera, double margin_m) const {
    const glm::dvec3& eye = camera.world_from_eye.position_m;
    const glm::dvec2 tangent{std::max(std::abs(camera.fov.left), std::abs(camera.fov.right)),
                             std::max(std::abs(camera.fov.down), std::abs(camera.fov.up))};
    // The corners of the near plane are this far away; a wall closer than that may be cut open.
    const double clear_m = camera.near_m * std::sqrt(1.0 + glm::dot(tangent, tangent));
    std::vector<int> first;
    double nearest_m = 1e30;
    double deepest_m = -1e30;
    for (std::size_t i = 1; i < graph_.cells.size(); ++i) {
        const scene::Bounds box = bounds_of(graph_.cells[i]);
        nearest_m = std::min(nearest_m, distance_m(eye, box));
        const double depth = depth_in_m(eye, box);
        if (depth >= 0.0) first.push_back(static_cast<int>(i));
        deepest_m = std::max(deepest_m, depth);
    }
    const bool clear_of_walls = deepest_m > clear_m;
    bool in_opening = false;
    for (const scene::Portal& portal : graph_.portals) {
        const PortalFrame frame = frame_of(portal);
        const double away_m = distance_m(eye, frame);
        if (away_m > std::max(margin_m + clear_m, kThickestWall_m)) continue;
        // In the opening, clear of its sides: the way on is open to both cells.
        const glm::dvec3 to = eye - frame.centre;
        const bool between = std::abs(glm::dot(to, frame.u)) < frame.half_u - clear_m &&
                             std::abs(glm::dot(to, frame.v)) < frame.half_v - clear_m;
        if (away_m <= margin_m + clear_m || (between && deepest_m <= clear_m)) {
            first.insert(first.end(), portal.cells.begin(), portal.cells.end());
        }
        in_opening = in_opening || between;
    }
    std::sort(first.begin(), first.end());
    first.erase(std::unique(first.begin(), first.end()), first.end());
    if (clear_of_walls || in_opening) return first;
    if (nearest_m > kThickestWall_m + clear_m) return {0};
    return {};
}

PortalWalk::Rect PortalWalk::rect_of(const scene::Bounds& bounds, const View& view) const {
    Rect rect;
    bool behind = true;
    bool reaches_before = false;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec3 point{(corner & 1U) != 0 ? bounds.max.x : bounds.min.x,
                               (corner & 2U) != 0 ? bounds.max.y : bounds.min.y,
                               (corner & 4U) != 0 ? bounds.max.z : bounds.min.z};
        const glm::dvec3 in_eye = view.eye_from_world * (point - view.eye_world);
        const double distance = -in_eye.z;
        if (distance <= view.near_m) {
            reaches_before = true;
            continue;
        }
        behind = false;
        const double x = in_eye.x / distance;
        const double y = in_eye.y / distance;
        rect.include({x - view.slack, x + view.slack, y - view.slack, y + view.slack});
    }
    // One that reaches before the near plane may be anywhere.
    return reaches_before && !behind ? view.whole : rect;
}

PortalWalk::Rect PortalWalk::seen_through(const scene::Portal& portal, const View& view) const {
    std::array<glm::dvec3, 4> corners{};
    double nearest = 1e30;
    double farthest = -1e30;
    for (std::size_t i = 0; i < 4; ++i) {
        corners[i] = view.eye_from_world * (portal.corners_world[i] - view.eye_world);
        nearest = std::min(nearest, -corners[i].z);
        farthest = std::max(farthest, -corners[i].z);
    }
    if (farthest <= 0.0) return {};  // behind the eye
    // Part of it behind the eye: cut there. Another eye within the margin sees it shifted by the margin over its
    // distance, more so the more obliquely.
    const double cut_m = std::max(0.5 * view.near_m, 2.0 * view.margin_m);
    if (nearest < cut_m && view.margin_m > 0.0) return view.whole;
    Rect rect;
    const auto include = [&](const glm::dvec3& point) {
        const double distance = -point.z;
        const double x = point.x / distance;
        const double y = point.y / distance;
        const double shift_x = view.slack + view.margin_m * (1.0 + std::abs(x)) / (distance - view.margin_m);
        const double shift_y = view.slack + view.margin_m * (1.0 + std::abs(y)) / (distance - view.margin_m);
        rect.include({x - shift_x, x + shift_x, y - shift_y, y + shift_y});
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3& a = corners[i];
        const glm::dvec3& b = corners[(i + 1) % 4];
        if (-a.z >= cut_m) include(a);
        if ((-a.z < cut_m) != (-b.z < cut_m)) include(a + (b - a) * ((-cut_m - a.z) / (b.z - a.z)));
    }
    // What lies before the cut is nearer than half the near plane, and everything it could show is there too.
    return rect;
}

void PortalWalk::enter(int cell, const Rect& rect) {
    Rect& known = rects_[static_cast<std::size_t>(cell)];
    if (known.empty()) {
        order_.push_back(cell);
    } else if (known.holds(rect)) {
        return;
    }
    known.include(rect);
    waiting_.push_back(cell);
}

void PortalWalk::leave_through_portals(int cell, const View& view, const std::vector<int>& first) {
    const Rect rect = rects_[static_cast<std::size_t>(cell)];
    for (const int index : graph_.cells[static_cast<std::size_t>(cell)].portals) {
        const scene::Portal& portal = graph_.portals[static_cast<std::size_t>(index)];
        const int next = portal.cells[0] == cell ? portal.cells[1] : portal.cells[0];
        const bool ever_seen =
            std::any_of(first.begin(), first.end(), [&](int from) { return graph_.may_see(from, next); });
        if (!ever_seen) continue;
        Rect through = seen_through(portal, view);
        through.left = std::max(through.left, rect.left);
        through.right = std::min(through.right, rect.right);
        through.down = std::max(through.down, rect.down);
        through.up = std::min(through.up, rect.up);
        if (!through.empty()) enter(next, through);
    }
}

bool PortalWalk::append_seen(const Camera& camera, double margin_m, std::vector<std::uint32_t>& seen) {
    for (const int cell : order_) rects_[static_cast<std::size_t>(cell)] = {};
    order_.clear();
    waiting_.clear();
    const std::vector<int> first = first_cells(camera, margin_m);
    if (first.empty()) return false;
    View view;
    view.eye_world = camera.world_from_eye.position_m;
    view.eye_from_world = glm::transpose(glm::mat3_cast(camera.world_from_eye.orientation));
    view.near_m = camera.near_m;
    view.margin_m = margin_m;
    view.slack = 0.1 * std::max((camera.fov.right - camera.fov.left) / camera.size_px.x,
                                (camera.fov.up - camera.fov.down) / camera.size_px.y);
    view.whole = {camera.fov.left, camera.fov.right, camera.fov.down, camera.fov.up};
    for (const int cell : first) enter(cell, view.whole);
    while (!waiting_.empty()) {
        const int cell = waiting_.back();
        waiting_.pop_back();
        leave_through_portals(cell, view, first);
    }
    ++walk_;
    for (const int cell : order_) {
        const Rect& rect = rects_[static_cast<std::size_t>(cell)];
        for (const std::uint32_t object : objects_[static_cast<std::size_t>(cell)]) {
            if (taken_in_[object] == walk_ || placed_[object].bounds_world.empty()) continue;
            const Rect object_rect = rect_of(placed_[object].bounds_world, view);
            if (object_rect.left > rect.right || object_rect.right < rect.left || object_rect.down > rect.up ||
                object_rect.up < rect.down) {
                continue;
            }
            taken_in_[object] = walk_;
            seen.push_back(object);
        }
    }
    take_movers(view, seen);
    return true;
}

void PortalWalk::take_movers(const View& view, std::vector<std::uint32_t>& seen) const {
    for (const std::uint32_t mover : placed_.movers()) {
        const scene::Bounds& bounds = placed_[mover].bounds_world;
        if (bounds.empty()) continue;
        bool in_any = false;
        bool in_entered = false;
        // Half the thickest wall: in a doorway it stands between two cells.
        const glm::dvec3 reach{0.5 * kThickestWall_m};
        for (std::size_t i = 1; i < graph_.cells.size() && !in_entered; ++i) {
            const scene::Cell& cell = graph_.cells[i];
            const bool touches = glm::all(glm::lessThanEqual(bounds.min - reach, cell.max_world)) &&
                                 glm::all(glm::greaterThanEqual(bounds.max + reach, cell.min_world));
            in_any = in_any || touches;
            in_entered = in_entered || (touches && !rects_[i].empty());
        }
        if (in_any && !in_entered) continue;
        const Rect rect = rect_of(bounds, view);
        const bool in_view = rect.left <= view.whole.right && rect.right >= view.whole.left &&
                             rect.down <= view.whole.up && rect.up >= view.whole.down;
        if (in_view) seen.push_back(mover);
    }
}

}  // namespace lw
