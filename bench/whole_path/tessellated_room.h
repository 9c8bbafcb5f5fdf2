#pragma once
/// One picture out of any number of triangles.

#include <cstdint>

#include "scene/scene.h"

namespace lw::bench {

/// A textured floor, a back wall and a grid of boxes in front of it, every face cut into a grid of small triangles: as
/// many as come nearest to `triangles` from above. The faces stay flat, so the picture does not depend on the number.
/// Deterministic. @param triangles  at least 1000
[[nodiscard]] scene::Scene tessellated_room(std::uint64_t triangles);

/// Half floor and boxes, half sky, from 1.6 m above the floor.
[[nodiscard]] Camera room_camera(glm::ivec2 size_px);

}  // namespace lw::bench
