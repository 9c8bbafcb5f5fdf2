#include "apps/culling_map.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "client_renderer/culling.h"

namespace lw {

namespace {

constexpr Rgba8 kPaper{24, 26, 30, 255};
constexpr Rgba8 kOutside{70, 74, 80, 255};
constexpr Rgba8 kBehindWalls{52, 96, 170, 255};
constexpr Rgba8 kHidden{196, 70, 58, 255};
constexpr Rgba8 kDrawn{94, 190, 98, 255};
constexpr Rgba8 kInk{255, 255, 255, 255};

/// World x and z to pixels.
class Map {
public:
    Map(int side_px, const glm::dvec3& centre_world, double reach_m)
        : image_{{side_px, side_px}}, centre_{centre_world}, px_per_m_{0.5 * side_px / reach_m} {
        std::ranges::fill(image_.pixels(), kPaper);
    }

    /// Its outline, and its inside at a third of the colour: boxes in boxes stay visible.
    void draw(const scene::Bounds& box, Rgba8 colour) {
        const glm::dvec2 low = px_of(box.min);
        const glm::dvec2 high = px_of(box.max);
        const int x0 = std::max(static_cast<int>(std::floor(low.x)), -1);
        const int y0 = std::max(static_cast<int>(std::floor(low.y)), -1);
        const int x1 = std::min(static_cast<int>(std::ceil(high.x)), image_.size_px().x);
        const int y1 = std::min(static_cast<int>(std::ceil(high.y)), image_.size_px().y);
        for (int y = y0; y <= y1; ++y) {
            for (int x = x0; x <= x1; ++x) {
                const bool edge = x == x0 || x == x1 || y == y0 || y == y1;
                put(x, y, colour, edge ? 1.0 : 0.08);
            }
        }
    }

    void draw_line(const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec2 a = px_of(from);
        const glm::dvec2 b = px_of(to);
        const int steps = static_cast<int>(std::max(std::abs(b.x - a.x), std::abs(b.y - a.y))) + 1;
        for (int i = 0; i <= steps; ++i) {
            const glm::dvec2 at = a + (b - a) * (static_cast<double>(i) / steps);
            put(static_cast<int>(at.x), static_cast<int>(at.y), kInk, 1.0);
        }
    }

    [[nodiscard]] ColourImage take() { return std::move(image_); }

private:
    [[nodiscard]] glm::dvec2 px_of(const glm::dvec3& world) const {
        const double half = 0.5 * image_.size_px().x;
        return {half + (world.x - centre_.x) * px_per_m_, half + (world.z - centre_.z) * px_per_m_};
    }
    void put(int x, int y, Rgba8 colour, double share) {
        if (x < 0 || y < 0 || x >= image_.size_px().x || y >= image_.size_px().y) return;
        Rgba8& pixel = image_.at(x, y);
        const auto mixed = [share](std::uint8_t old_value, std::uint8_t new_value) {
            return static_cast<std::uint8_t>(old_value + (new_value - old_value) * share + 0.5);
        };
        pixel = {mixed(pixel.r, colour.r), mixed(pixel.g, colour.g), mixed(pixel.b, colour.b), 255};
    }

    ColourImage image_;
    glm::dvec3 centre_;
    double px_per_m_;
};

void draw_view(Map& map, const Camera& camera, double reach_m) {
    const glm::dmat3 axes = glm::mat3_cast(camera.world_from_eye.orientation);
    const glm::dvec3& eye = camera.world_from_eye.position_m;
    for (const double tangent : {camera.fov.left, camera.fov.right}) {
        glm::dvec3 direction = axes * glm::dvec3{tangent, 0.0, -1.0};
        direction.y = 0.0;
        if (glm::length(direction) > 1e-6) map.draw_line(eye, eye + 2.0 * reach_m * glm::normalize(direction));
    }
    map.draw({eye - 0.01 * reach_m, eye + 0.01 * reach_m}, kInk);
}

}  // namespace

ColourImage culling_map(const scene::Scene& scene, const CullingSettings& settings, const Camera& camera,
                        double scene_time_s, int side_px) {
    scene::SceneState state{scene};
    state.set_time(scene_time_s);
    const PlacedInstances placed{scene, state};
    Culling culling{placed, settings};
    std::vector<Rgba8> colours(placed.size(), kOutside);
    const bool through_portals = [&] {
        for (const std::uint32_t object : culling.visible(camera)) colours[object] = kDrawn;
        return culling.counters().behind_walls > 0;
    }();
    const Frustum frustum = frustum_of(camera);
    const glm::dvec3& eye = camera.world_from_eye.position_m;
    double reach_m = 5.0;
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const scene::Bounds& box = placed[i].bounds_world;
        if (colours[i] == kDrawn) {
            const glm::dvec3 half = box.half_size();
            // Ground and hills reach everywhere; they say nothing about how far one sees.
            if (std::max(half.x, half.z) < 50.0) reach_m = std::max(reach_m, glm::distance(box.centre(), eye));
        } else if (may_see(frustum, box)) {
            colours[i] = through_portals ? kBehindWalls : kHidden;
        }
    }
    Map map{side_px, eye, 1.25 * reach_m};
    for (const Rgba8 layer : {kOutside, kBehindWalls, kHidden, kDrawn}) {
        for (std::size_t i = 0; i < placed.size(); ++i) {
            if (colours[i] == layer && !placed[i].bounds_world.empty()) map.draw(placed[i].bounds_world, layer);
        }
    }
    draw_view(map, camera, 1.25 * reach_m);
    return map.take();
}

}  // namespace lw
