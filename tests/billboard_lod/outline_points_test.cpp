#include "billboard_lod/outline_points.h"

#include <gtest/gtest.h>

#include <random>

namespace lw {
namespace {

scene::Mesh mesh_of(std::size_t vertices, unsigned seed) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<float> place{-1.0F, 1.0F};
    scene::Mesh mesh;
    for (std::size_t i = 0; i < vertices; ++i) {
        scene::Vertex vertex;
        // A thin sheet across the diagonal of its box.
        const float x = place(random);
        vertex.position_object = {x, x + 0.1F * place(random), 3.0F * place(random)};
        mesh.vertices.push_back(vertex);
        mesh.bounds.include(glm::dvec3{vertex.position_object});
    }
    return mesh;
}

double reach(const std::vector<glm::dvec3>& points, const glm::dvec3& direction) {
    double most = -1e300;
    for (const glm::dvec3& point : points) most = std::max(most, glm::dot(point, direction));
    return most;
}

TEST(OutlinePoints, HoldTheMeshAndStayInItsBox) {
    const scene::Mesh mesh = mesh_of(5000, 1);
    const std::vector<glm::dvec3> points = outline_points(mesh);
    EXPECT_LE(points.size(), 512U);
    std::vector<glm::dvec3> vertices;
    for (const scene::Vertex& vertex : mesh.vertices) vertices.emplace_back(vertex.position_object);
    for (int i = 0; i < 64; ++i) {
        const glm::dvec3 direction{std::cos(0.7 * i), std::sin(1.3 * i), std::sin(0.4 * i + 1.0)};
        EXPECT_GE(reach(points, direction), reach(vertices, direction));
    }
    for (const glm::dvec3& point : points) {
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(point, mesh.bounds.min)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(point, mesh.bounds.max)));
    }
}

TEST(OutlinePoints, LieCloserThanTheBox) {
    const std::vector<glm::dvec3> points = outline_points(mesh_of(5000, 2));
    // Across the sheet: the box reaches 2.1, the sheet 0.1, a cell of it half a unit more.
    EXPECT_LT(reach(points, {1.0, -1.0, 0.0}), 0.7);
}

TEST(OutlinePoints, OfFewVerticesAreTheVertices) {
    EXPECT_EQ(outline_points(mesh_of(3, 3)).size(), 3U);
    EXPECT_TRUE(outline_points(scene::Mesh{}).empty());
}

}  // namespace
}  // namespace lw
