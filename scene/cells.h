#pragma once
/// Cells and portals: the rooms of a building and the openings between them, for scenes that know theirs.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// An opening between two cells: a flat convex quadrilateral, its corners in order around it.
struct Portal {
    std::array<glm::dvec3, 4> corners_world{};
    std::array<int, 2> cells{};  ///< the cells on its two sides
};

/// A space that is seen into only through its portals. Cell 0 is the outside, whatever lies in no other cell.
struct Cell {
    glm::dvec3 min_world{0.0};
    glm::dvec3 max_world{0.0};
    std::vector<int> portals;
    std::vector<std::uint32_t> instances;  ///< static ones, indices into Scene::instances
};

/// Empty for scenes that know no cells. A static instance of a scene that has some is in at least one of them.
struct CellGraph {
    std::vector<Cell> cells;
    std::vector<Portal> portals;
    /// From any point of a cell, the others that may be seen through some row of portals: one bit per cell, row by row,
    /// words_per_cell() each. It may name a cell that is not seen, never leave out one that is.
    std::vector<std::uint64_t> visible;

    [[nodiscard]] bool empty() const { return cells.empty(); }
    [[nodiscard]] std::size_t words_per_cell() const { return (cells.size() + 63) / 64; }
    [[nodiscard]] bool may_see(int from, int to) const {
        const std::size_t word = static_cast<std::size_t>(from) * words_per_cell() + static_cast<std::size_t>(to) / 64;
        return (visible[word] >> (static_cast<unsigned>(to) % 64U) & 1U) != 0;
    }
    /// The cell that holds a point; 0 when none does.
    [[nodiscard]] int cell_at(const glm::dvec3& point_world) const;
    /// Fills `visible` from cells and portals: a portal is followed while a straight line through all portals since the
    /// first may exist, tested with planes that separate the first from the last (Teller and Sequin 1991, "Visibility
    /// preprocessing for interactive walkthroughs").
    void find_visible();
};

/// The cells and portals that a scene's nodes tell of, with `visible` filled; empty when there are none.
///
/// They are stored as nodes, so that a glTF file can carry them too: a node named "cell N", N from 1 without gaps,
/// holds what is in the cell, and a child named "extent" takes the cube from -1 to 1 to the cell's box; what is in
/// several cells hangs below a node named "cell N+M"; a node named "portal N-M" takes the square from (-1, -1, 0) to
/// (1, 1, 0) to the opening between two cells, 0 being the outside. Everything else is outside. Only static,
/// axis-aligned extents count; a scene whose cells do not add up has none.
[[nodiscard]] CellGraph cells_of(const Scene& scene);

}  // namespace lw::scene
