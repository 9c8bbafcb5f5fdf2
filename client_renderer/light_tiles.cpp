#include "client_renderer/light_tiles.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/check.h"

namespace lw {

namespace {

struct TileRect {
    glm::ivec2 first{0};
    glm::ivec2 last{-1};  ///< inclusive
};

// The sphere's box in eye space, projected: its sides are seen at the nearest and farthest distance of the box.
TileRect touched_tiles(const glm::dvec3& centre_eye, double range_m, const Camera& camera, glm::ivec2 tiles) {
    const double nearest_m = -centre_eye.z - range_m;
    const double farthest_m = -centre_eye.z + range_m;
    if (farthest_m < camera.near_m) return {};
    if (nearest_m < camera.near_m) return {{0, 0}, tiles - 1};  // the eye is inside, or nearly
    const auto lowest_tan = [&](double edge) { return std::min(edge / nearest_m, edge / farthest_m); };
    const auto highest_tan = [&](double edge) { return std::max(edge / nearest_m, edge / farthest_m); };
    const FovTangents& fov = camera.fov;
    const double px_per_tan_x = camera.size_px.x / (fov.right - fov.left);
    const double px_per_tan_y = camera.size_px.y / (fov.up - fov.down);
    const glm::dvec2 first_px{(lowest_tan(centre_eye.x - range_m) - fov.left) * px_per_tan_x,
                              (fov.up - highest_tan(centre_eye.y + range_m)) * px_per_tan_y};
    const glm::dvec2 last_px{(highest_tan(centre_eye.x + range_m) - fov.left) * px_per_tan_x,
                             (fov.up - lowest_tan(centre_eye.y - range_m)) * px_per_tan_y};
    // One pixel of margin for the float positions in the shader. Clamped as doubles: tangents may be huge.
    const glm::dvec2 limit{camera.size_px};
    const glm::dvec2 first = glm::clamp(first_px - 1.0, glm::dvec2{-1.0}, limit) / double{shader::kLightTilePx};
    const glm::dvec2 last = glm::clamp(last_px + 1.0, glm::dvec2{-1.0}, limit) / double{shader::kLightTilePx};
    return {glm::max(glm::ivec2{glm::floor(first)}, 0), glm::min(glm::ivec2{glm::floor(last)}, tiles - 1)};
}

}  // namespace

glm::ivec2 LightTiles::tiles_for(glm::ivec2 size_px) {
    return (size_px + shader::kLightTilePx - 1) / shader::kLightTilePx;
}

void LightTiles::build(const std::vector<scene::PointLight>& lights, const Camera& camera) {
    LW_CHECK(lights.size() <= static_cast<std::size_t>(shader::kMaxLights), "too many point lights");
    const glm::ivec2 tiles = tiles_for(camera.size_px);
    masks_.assign(static_cast<std::size_t>(tiles.x) * static_cast<std::size_t>(tiles.y), glm::uvec2{0});
    const glm::dquat eye_from_world = glm::conjugate(camera.world_from_eye.orientation);
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const glm::dvec3 position_relative = lights[i].position_world - camera.world_from_eye.position_m;
        block_.position_range[i] = {glm::vec3{position_relative}, lights[i].range_m};
        block_.intensity[i] = glm::vec4{lights[i].intensity, 0.0f};

        const TileRect rect = touched_tiles(eye_from_world * position_relative, lights[i].range_m, camera, tiles);
        for (int y = rect.first.y; y <= rect.last.y; ++y) {
            for (int x = rect.first.x; x <= rect.last.x; ++x) {
                glm::uvec2& mask = masks_[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles.x) +
                                          static_cast<std::size_t>(x)];
                mask[i < 32 ? 0 : 1] |= 1U << (i % 32);
            }
        }
    }
}

}  // namespace lw
