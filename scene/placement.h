#pragma once
/// Affine matrices as translation, rotation and scale, as glTF writes them.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace lw::scene {

struct Placement {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
};

/// translation * rotation * scale. Pure, any thread.
[[nodiscard]] glm::dmat4 matrix_of(const Placement& placement);

/// The placement whose matrix is `matrix` within 1e-6 of its largest entry; nothing where there is shear, a scale of
/// zero, or no affine matrix. A mirror becomes a negative x scale. Pure, any thread.
[[nodiscard]] std::optional<Placement> placement_of(const glm::dmat4& matrix);

}  // namespace lw::scene
