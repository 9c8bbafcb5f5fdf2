#pragma once
/// Which instances of a scene are one object to the billboards.

#include <cstdint>
#include <vector>

#include "core/object_transform.h"
#include "scene/scene.h"

namespace lw {

/// One billboard's worth of a scene: an instance in its own object space, or several static instances that touch, in
/// world space.
struct BillboardObject {
    std::vector<std::uint32_t> instances;
    scene::Bounds bounds;  ///< object space of a single instance, world space of a group
    ObjectId id = 0;       ///< the mover, 0 for what is static

    [[nodiscard]] bool group() const { return instances.size() > 1; }
};

/// Members that a group may have: a crowd in one billboard would be updated as often as its nearest member needs.
inline constexpr std::size_t kMaxGroupSize = 6;

/// The objects of a scene whose instances stand as `state` says. With `group_touching`, static instances of similar
/// size whose boxes overlap share one object, pairs of least distance first; movers always stay alone. `eligible[i]`
/// says whether instance i may become a billboard; the others are in no object.
[[nodiscard]] std::vector<BillboardObject> billboard_objects(const scene::Scene& scene, const scene::SceneState& state,
                                                             const std::vector<bool>& eligible, bool group_touching);

}  // namespace lw
