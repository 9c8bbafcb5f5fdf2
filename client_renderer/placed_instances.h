#pragma once
/// Every instance of a scene where it stands now, grouped by mesh.

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lw {

/// Three cache lines: what is seen of a large scene lies scattered over it.
struct alignas(64) PlacedInstance {
    const scene::Instance* instance = nullptr;
    int mesh = 0;  ///< the instance's, as the mover: what every frame asks for is in one place
    ObjectId mover = 0;
    bool mirrored = false;  ///< the transform turns the mesh inside out
    glm::dmat4 world_from_object{1.0};
    scene::Bounds bounds_world;
};
static_assert(sizeof(PlacedInstance) == 192);

/// In the order in which objects are drawn: by mesh, and within a mesh as in the scene. One thread at a time.
class PlacedInstances {
public:
    /// `scene` is finished and outlives this; `state` is at any time.
    PlacedInstances(const scene::Scene& scene, const scene::SceneState& state);

    /// Places the movers anew; what is static keeps its place.
    void move(const scene::SceneState& state);

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] std::size_t size() const { return placed_.size(); }
    [[nodiscard]] const PlacedInstance& operator[](std::size_t i) const { return placed_[i]; }
    [[nodiscard]] std::span<const PlacedInstance> all() const { return placed_; }
    /// Indices of what moves, ascending.
    [[nodiscard]] std::span<const std::uint32_t> movers() const { return movers_; }

private:
    void place(PlacedInstance& placed, const scene::SceneState& state) const;

    const scene::Scene& scene_;
    std::vector<PlacedInstance> placed_;
    std::vector<std::uint32_t> movers_;
};

}  // namespace lw
