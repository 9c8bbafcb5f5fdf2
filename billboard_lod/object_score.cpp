#include "billboard_lod/object_score.h"

namespace lw {

double mesh_distance_m(const scene::Bounds& scene_bounds_world, double share) {
    if (scene_bounds_world.empty()) return 0.0;
    return share * glm::distance(scene_bounds_world.min, scene_bounds_world.max);
}

double object_score(const ProjectedBounds& bounds, double mesh_distance_m) {
    if (!bounds.visible) return -1.0;
    if (!bounds.usable || bounds.nearest_m() <= mesh_distance_m) return 0.0;
    const double size_m = bounds.size_m();
    // A point has no size and is nothing to draw; as a mesh it costs nothing either.
    return size_m > 0.0 ? (bounds.nearest_m() + bounds.farthest_m()) / size_m : 0.0;
}

}  // namespace lw
