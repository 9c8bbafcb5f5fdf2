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
    // The same as below without roots and quotients, for lengths whose sixth powers a double holds.
    const glm::dvec3 square{glm::dot(axes[0], axes[0]), glm::dot(axes[1], axes[1]), glm::dot(axes[2], axes[2])};
    constexpr double kSmall = 1e-40;
    constexpr double kLarge = 1e40;
    if (glm::all(glm::greaterThan(square, glm::dvec3{kSmall})) && glm::all(glm::lessThan(square, glm::dvec3{kLarge}))) {
        const double volume = glm::determinant(axes);
        return volume * volume >= kLeastVolume * kLeastVolume * (square.x * square.y * square.z);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(axes[axis]);  // lengths whose squares a double cannot hold fail below
        if (!(length >= kShortest && length <= kLongest)) return false;
        axes[axis] /= length;
    }
    return std::abs(glm::determinant(axes)) >= kLeastVolume;
}

}  // namespace lw
