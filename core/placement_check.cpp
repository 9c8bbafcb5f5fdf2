#include "core/placement_check.h"

#include <cmath>

namespace lw {

bool is_placement(const glm::dmat4& world_from_object) {
    for (int column = 0; column < 4; ++column) {
        const glm::dvec4& v = world_from_object[column];
        if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
        if (v.w != (column == 3 ? 1.0 : 0.0)) return false;
    }
    return true;
}

bool is_invertible_placement(const glm::dmat4& world_from_object) {
    constexpr double kLeastVolume = 1e-9;
    constexpr double kShortest = 1e-100;
    constexpr double kLongest = 1e100;
    if (!is_placement(world_from_object)) return false;
    glm::dmat3 axes{world_from_object};
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(axes[axis]);  // lengths whose squares a double cannot hold fail below
        if (!(length >= kShortest && length <= kLongest)) return false;
        axes[axis] /= length;
    }
    return std::abs(glm::determinant(axes)) >= kLeastVolume;
}

}  // namespace lw
