#include "billboard_lod/outline_points.h"

#include <array>

namespace lw {

namespace {

constexpr int kCells = 4;

}  // namespace

std::vector<glm::dvec3> outline_points(const scene::Mesh& mesh) {
    std::array<scene::Bounds, kCells * kCells * kCells> cells;
    const glm::dvec3 size = glm::max(mesh.bounds.max - mesh.bounds.min, glm::dvec3{1e-30});
    for (const scene::Vertex& vertex : mesh.vertices) {
        const glm::dvec3 place{vertex.position_object};
        const glm::dvec3 part = (place - mesh.bounds.min) / size * static_cast<double>(kCells);
        const glm::ivec3 cell = glm::clamp(glm::ivec3{part}, 0, kCells - 1);
        cells[static_cast<std::size_t>((cell.z * kCells + cell.y) * kCells + cell.x)].include(place);
    }
    std::vector<glm::dvec3> points;
    for (const scene::Bounds& cell : cells) {
        for (int corner = 0; corner < 8 && !cell.empty(); ++corner) {
            points.emplace_back((corner & 1) != 0 ? cell.max.x : cell.min.x,
                                (corner & 2) != 0 ? cell.max.y : cell.min.y,
                                (corner & 4) != 0 ? cell.max.z : cell.min.z);
        }
    }
    if (points.size() <= mesh.vertices.size()) return points;
    points.clear();
    for (const scene::Vertex& vertex : mesh.vertices) points.emplace_back(vertex.position_object);
    return points;
}

}  // namespace lw
