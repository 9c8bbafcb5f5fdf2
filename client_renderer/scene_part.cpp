#include "client_renderer/scene_part.h"

#include <glm/glm.hpp>

namespace lw {

bool in_range(const ScenePart& part, const scene::Bounds& bounds_world, bool is_mover, const glm::dvec3& eye_world) {
    if (is_mover) return part.movers;
    const glm::dvec3 nearest = glm::clamp(eye_world, bounds_world.min, bounds_world.max);
    if (!(glm::distance(nearest, eye_world) < part.farthest_m)) return false;
    const glm::dvec3 farthest =
        glm::max(glm::abs(bounds_world.min - eye_world), glm::abs(bounds_world.max - eye_world));
    return glm::length(farthest) >= part.nearest_m;
}

std::uint64_t empty_what_is_not_in(const ScenePart& part, CpuPixels& pixels) {
    if (part.sky && part.behind == nullptr) return 0;
    std::uint64_t emptied = 0;
    for (std::size_t i = 0; i < pixels.depth.pixels().size(); ++i) {
        if (pixels.depth.pixels()[i] != 0.0F) continue;
        if (part.sky && part.behind->pixels()[i] != 0.0F) continue;
        pixels.depth.pixels()[i] = kNoSurfaceDepth;
        pixels.colour.pixels()[i] = {0, 0, 0, 0};
        pixels.object_id.pixels()[i] = 0;
        ++emptied;
    }
    return emptied;
}

}  // namespace lw
