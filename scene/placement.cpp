#include "scene/placement.h"

#include <algorithm>
#include <cmath>

namespace lw::scene {

glm::dmat4 matrix_of(const Placement& placement) {
    glm::dmat4 matrix = glm::mat4_cast(placement.rotation);
    matrix[0] *= placement.scale.x;
    matrix[1] *= placement.scale.y;
    matrix[2] *= placement.scale.z;
    matrix[3] = glm::dvec4{placement.translation, 1.0};
    return matrix;
}

std::optional<Placement> placement_of(const glm::dmat4& matrix) {
    const glm::dmat3 linear{matrix};
    Placement placement;
    placement.translation = glm::dvec3{matrix[3]};
    placement.scale = {glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])};
    if (!(std::min({placement.scale.x, placement.scale.y, placement.scale.z}) > 0.0)) return std::nullopt;
    if (glm::determinant(linear) < 0.0) placement.scale.x = -placement.scale.x;
    const glm::dmat3 rotation{linear[0] / placement.scale.x, linear[1] / placement.scale.y,
                              linear[2] / placement.scale.z};
    placement.rotation = glm::normalize(glm::quat_cast(rotation));
    const glm::dmat4 again = matrix_of(placement);
    double largest = 0.0;
    double difference = 0.0;
    for (glm::length_t column = 0; column < 4; ++column) {
        for (glm::length_t row = 0; row < 4; ++row) {
            largest = std::max(largest, std::abs(matrix[column][row]));
            difference = std::max(difference, std::abs(matrix[column][row] - again[column][row]));
        }
    }
    // float inputs carry 6e-8 of their size; shear that can be seen is far above this.
    if (!(difference <= 1e-6 * largest)) return std::nullopt;
    return placement;
}

}  // namespace lw::scene
