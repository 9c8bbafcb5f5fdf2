#include "core/surface_match.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <thread>
#include <vector>

#include "core/check.h"
#include "core/reprojection.h"

namespace lw {
namespace {

constexpr double kDepthTolerance = 0.03;
constexpr double kSmallestDepth = 1e-9;  // farther away than any scene is large

// Change of depth per pixel along one axis. Of the differences to both sides the smaller one: it is the one that stays
// on the surface beside an edge.
double depth_slope(const SampledView& view, glm::ivec2 pixel, glm::ivec2 step) {
    const ObjectId id = view.object_id.at(pixel.x, pixel.y);
    const double depth = view.depth.at(pixel.x, pixel.y);
    std::optional<double> slope;
    for (const int sign : {-1, 1}) {
        const glm::ivec2 beside = pixel + sign * step;
        const bool inside =
            beside.x >= 0 && beside.y >= 0 && beside.x < view.depth.width() && beside.y < view.depth.height();
        if (!inside || view.object_id.at(beside.x, beside.y) != id) continue;
        const double difference = sign * (static_cast<double>(view.depth.at(beside.x, beside.y)) - depth);
        if (!slope || std::abs(difference) < std::abs(*slope)) slope = difference;
    }
    return slope.value_or(0.0);
}

// Depth in the other picture as an affine function of its pixels.
struct PlaneThere {
    glm::dvec2 position_px{0.0};
    double depth = 0.0;
    glm::dvec2 slope{0.0};

    [[nodiscard]] double depth_at(const glm::dvec2& place_px) const {
        return depth + glm::dot(slope, place_px - position_px);
    }
};

// From three points of the surface's plane; no slope where they fall on one line.
std::optional<PlaneThere> plane_there(const SampledView& from, glm::ivec2 pixel,
                                      const Transform<TargetPx, SourcePx>& to_from) {
    const glm::dvec2 centre_px = glm::dvec2{pixel} + 0.5;
    const double depth = from.depth.at(pixel.x, pixel.y);
    const auto centre = reproject(to_from, centre_px, depth);
    if (!centre) return std::nullopt;
    PlaneThere plane{centre->position_px, centre->depth, {}};
    constexpr double kStep_px = 0.5;
    const auto right =
        reproject(to_from, centre_px + glm::dvec2{kStep_px, 0.0}, depth + kStep_px * depth_slope(from, pixel, {1, 0}));
    const auto below =
        reproject(to_from, centre_px + glm::dvec2{0.0, kStep_px}, depth + kStep_px * depth_slope(from, pixel, {0, 1}));
    if (!right || !below) return plane;
    const glm::dvec2 u = right->position_px - centre->position_px;
    const glm::dvec2 v = below->position_px - centre->position_px;
    const double area = u.x * v.y - u.y * v.x;
    if (std::abs(area) < 1e-6) return plane;
    const double du = right->depth - centre->depth;
    const double dv = below->depth - centre->depth;
    plane.slope = {(du * v.y - dv * u.y) / area, (dv * u.x - du * v.x) / area};
    return plane;
}

bool lies_on(const SampledView& to, const PlaneThere& plane, ObjectId id, glm::ivec2 pixel) {
    if (to.object_id.at(pixel.x, pixel.y) != id) return false;
    const double expected = plane.depth_at(glm::dvec2{pixel} + 0.5);
    const double found = to.depth.at(pixel.x, pixel.y);
    return std::abs(found - expected) <= kDepthTolerance * std::max(std::abs(plane.depth), found) + kSmallestDepth;
}

SurfacePlace place_of(const SampledView& from, const SampledView& to, glm::ivec2 pixel,
                      const ReprojectionTable& table) {
    SurfacePlace place;
    const ObjectId id = from.object_id.at(pixel.x, pixel.y);
    const Transform<TargetPx, SourcePx>* to_from = table.find(id);
    if (to_from == nullptr) {
        place.visibility = Visibility::hidden;
        return place;
    }
    const std::optional<PlaneThere> plane = plane_there(from, pixel, *to_from);
    if (!plane || plane->depth > 1.0) return place;
    place.position_px = plane->position_px;
    const glm::ivec2 size_px = to.depth.size_px();
    const bool inside = place.position_px.x >= 0.0 && place.position_px.y >= 0.0 && place.position_px.x < size_px.x &&
                        place.position_px.y < size_px.y;
    if (!inside) return place;
    place.visibility = Visibility::hidden;
    const glm::dvec2 first = glm::floor(place.position_px - 0.5);
    const glm::dvec2 part = place.position_px - 0.5 - first;
    double sum = 0.0;
    std::array<double, 4> weights{};
    for (int i = 0; i < 4; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const glm::ivec2 step{i & 1, i >> 1};
        place.neighbours[k] = glm::clamp(glm::ivec2{first} + step, glm::ivec2{0}, size_px - 1);
        if (!lies_on(to, *plane, id, place.neighbours[k])) continue;
        // A neighbour on the surface counts even where its weight is 0: the surface was seen beside the place.
        weights[k] = (step.x == 0 ? 1.0 - part.x : part.x) * (step.y == 0 ? 1.0 - part.y : part.y) + 1e-6;
        sum += weights[k];
    }
    if (sum == 0.0) return place;
    place.visibility = Visibility::seen;
    for (std::size_t k = 0; k < 4; ++k) place.weights[k] = static_cast<float>(weights[k] / sum);
    return place;
}

void check_sizes(const SampledView& view) {
    LW_CHECK(view.depth.size_px() == view.camera.size_px && view.object_id.size_px() == view.camera.size_px,
             "depth and ids of a sampled view are of its camera's size");
}

}  // namespace

void match_surfaces(const SampledView& from, const SampledView& to, int threads,
                    const std::function<void(int x, int y, const SurfacePlace& place)>& use) {
    check_sizes(from);
    check_sizes(to);
    ReprojectionTable table;
    table.build(from.camera, to.camera, from.movers, to.movers);
    std::atomic<int> next_row{0};
    const auto take_rows = [&] {
        for (int y = next_row++; y < from.depth.height(); y = next_row++) {
            for (int x = 0; x < from.depth.width(); ++x) use(x, y, place_of(from, to, {x, y}, table));
        }
    };
    std::vector<std::thread> others;
    const int available = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
    for (int i = 1; i < available; ++i) others.emplace_back(take_rows);
    take_rows();
    for (std::thread& thread : others) thread.join();
}

}  // namespace lw
