#pragma once
/// A box divided into cells, some of them touched by a surface: what lies inside it and what outside.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// Cells first..last on each axis, last included; empty when last < first.
struct CellBox {
    glm::ivec3 first{0};
    glm::ivec3 last{-1};

    [[nodiscard]] double count() const {
        const glm::dvec3 size = glm::dvec3{last - first} + 1.0;
        return size.x <= 0.0 || size.y <= 0.0 || size.z <= 0.0 ? 0.0 : size.x * size.y * size.z;
    }
};

/// One thread.
class CellGrid {
public:
    static constexpr int kCells = 28;  ///< per axis: a house's cells are 0.4 m, a second box grows to its surface

    /// `bounds` has some size on every axis.
    explicit CellGrid(const Bounds& bounds);

    /// The cells that a triangle may touch are surface from now on.
    void mark(const std::array<glm::dvec3, 3>& triangle);

    /// Decides which cells are solid: not surface, and not to be reached from outside over neighbouring cells. Sides in
    /// `open_sides` (bits as in SolidBox) let nothing in.
    void find_solid(unsigned open_sides);

    /// How many cells are solid: no box has more.
    [[nodiscard]] double solid_count() const;

    /// The box of solid cells with the most cells; they are solid no longer. Empty when there are none.
    [[nodiscard]] CellBox take_largest_solid_box();

    [[nodiscard]] Bounds bounds_of(const CellBox& cells) const;
    [[nodiscard]] const glm::dvec3& cell_size() const { return cell_size_; }
    [[nodiscard]] static double cell_count() { return 1.0 * kCells * kCells * kCells; }

private:
    static constexpr std::size_t index(int x, int y, int z) {
        return static_cast<std::size_t>((z * kCells + y) * kCells + x);
    }
    void mark_small(const std::array<glm::dvec3, 3>& cell_triangle);

    Bounds bounds_;
    glm::dvec3 cell_size_{1.0};
    std::vector<std::uint8_t> surface_;
    std::vector<std::uint8_t> solid_;
};

}  // namespace lw::scene
