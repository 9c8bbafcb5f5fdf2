#include "client_renderer/placed_instances.h"

#include <algorithm>

namespace lw {

PlacedInstances::PlacedInstances(const scene::Scene& scene, const scene::SceneState& state) : scene_{scene} {
    placed_.reserve(scene.instances.size());
    for (const scene::Instance& instance : scene.instances)
        placed_.push_back({&instance, instance.mesh, instance.mover, false, {}, {}});
    std::ranges::stable_sort(placed_, {}, &PlacedInstance::mesh);
    for (std::size_t i = 0; i < placed_.size(); ++i) {
        place(placed_[i], state);
        if (placed_[i].mover != 0) movers_.push_back(static_cast<std::uint32_t>(i));
    }
}

void PlacedInstances::move(const scene::SceneState& state) {
    for (const std::uint32_t mover : movers_) place(placed_[mover], state);
}

void PlacedInstances::place(PlacedInstance& placed, const scene::SceneState& state) const {
    const scene::Mesh& mesh = scene_.meshes[static_cast<std::size_t>(placed.mesh)];
    placed.world_from_object = state.world_from_object(*placed.instance);
    placed.bounds_world = scene::transformed(mesh.bounds, placed.world_from_object);
    placed.mirrored = glm::determinant(glm::dmat3{placed.world_from_object}) < 0.0;
}

}  // namespace lw
