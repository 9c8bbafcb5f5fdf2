#pragma once
/// Sixteen boxes in cache lines that follow each other, for one wide vector or several narrower ones.

#include <array>
#include <cstddef>

#include "scene/scene.h"

namespace lw {

/// Axis-aligned, single precision.
struct alignas(64) BoxBlock {
    static constexpr std::size_t kBoxes = 16;

    /// Empty boxes, which are never seen.
    BoxBlock() {
        for (std::size_t row = 0; row < rows.size(); ++row) rows[row].fill(row < 3 ? 0.0F : -1.0F);
    }

    /// @return  whether it was another
    bool set(std::size_t box, const scene::Bounds& bounds) {
        const bool empty = bounds.empty();
        const glm::vec3 centre{empty ? glm::dvec3{0.0} : bounds.centre()};
        const glm::vec3 half{empty ? glm::dvec3{-1.0} : bounds.half_size()};
        bool other = false;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto a = static_cast<glm::length_t>(axis);
            other = other || rows[axis][box] != centre[a] || rows[3 + axis][box] != half[a];
            rows[axis][box] = centre[a];
            rows[3 + axis][box] = half[a];
        }
        return other;
    }

    std::array<std::array<float, kBoxes>, 6> rows;  ///< centre x y z, half size x y z
};

}  // namespace lw
