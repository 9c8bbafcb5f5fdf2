#pragma once
/// The placement of one mover at one time.

#include <cstdint>
#include <glm/glm.hpp>

namespace lw {

/// Object id in frames: 0 is sky and the static world, 1..65535 are movers.
using ObjectId = std::uint16_t;

struct ObjectTransform {
    ObjectId id = 0;
    glm::dmat4 world_from_object{1.0};  ///< affine: last row (0, 0, 0, 1)

    friend bool operator==(const ObjectTransform&, const ObjectTransform&) = default;
};

}  // namespace lw
