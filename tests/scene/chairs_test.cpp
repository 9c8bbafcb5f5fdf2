#include "scene/chairs.h"

#include <gtest/gtest.h>

#include <array>

#include "scene/chairs_chair.h"
#include "scene/chairs_scooter.h"
#include "scene/curved_surface.h"

namespace lw::scene {
namespace {

Scene small(std::uint64_t seed = 1, int movers = 0) {
    auto made = make_chairs({12, 9, movers, seed});
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

TEST(Chairs, HaveFiveThousandTrianglesAndSeveralMaterialsEach) {
    for (const Mesh& mesh : {make_chair({}, {}), make_scooter({}, {})}) {
        EXPECT_GE(mesh.indices.size() / 3, 5000U) << mesh.name;
        EXPECT_GE(mesh.primitives.size(), 3U) << mesh.name;
    }
}

TEST(Chairs, NormalsAreUnitAndFrontsFaceThem) {
    for (const Mesh& mesh : {make_chair({}, {}), make_scooter({}, {})}) {
        std::size_t against = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vertex& a = mesh.vertices[mesh.indices[i]];
            const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
            const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
            EXPECT_NEAR(glm::length(a.normal_object), 1.0, 1e-5) << mesh.name;
            const glm::vec3 front =
                glm::cross(b.position_object - a.position_object, c.position_object - a.position_object);
            if (glm::dot(front, a.normal_object + b.normal_object + c.normal_object) < 0.0f) ++against;
        }
        // Slivers at the tips of bodies may turn; whole parts may not.
        EXPECT_LE(against, mesh.indices.size() / 3 / 50) << mesh.name;
    }
}

TEST(Chairs, EveryObjectTouchesTheFloorAndStandsOnIt) {
    const Scene scene = small();
    ASSERT_EQ(scene.instances.size(), 22U);
    SceneState state{scene};
    state.set_time(0.0);
    for (std::size_t i = 1; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(scene.instances[i].mesh)];
        double lowest_m = 1e300;
        for (const Vertex& vertex : mesh.vertices) {
            lowest_m = std::min(
                lowest_m,
                (state.world_from_object(scene.instances[i]) * glm::dvec4{glm::dvec3{vertex.position_object}, 1.0}).y);
        }
        EXPECT_NEAR(lowest_m, 0.0, 1e-6) << i;
    }
}

TEST(Chairs, ASeedGivesTheSameSceneAndAnotherSeedAnother) {
    const auto places = [](const Scene& scene) {
        std::vector<glm::dvec3> all;
        for (const Node& node : scene.nodes) all.push_back(node.translation);
        return all;
    };
    EXPECT_EQ(places(small(3)), places(small(3)));
    EXPECT_NE(places(small(3)), places(small(4)));
}

TEST(Chairs, AsManyMoveAsWereAsked) {
    EXPECT_EQ(small(1, 5).movers.size(), 5U);
    EXPECT_EQ(small(1, 21).movers.size(), 21U);
    EXPECT_FALSE(make_chairs({2, 1, 4, 1}).ok());
}

TEST(CurvedSurface, AFlatSheetFacesOneWay) {
    MeshBuilder builder{"sheet"};
    builder.use_material(0, 1.0);
    const std::array<glm::dvec3, 6> points{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}};
    add_sheet(builder, points, 3, false);
    const Mesh mesh = builder.take();
    EXPECT_EQ(mesh.indices.size(), 12U);
    for (const Vertex& vertex : mesh.vertices) EXPECT_EQ(vertex.normal_object, glm::vec3(0, 0, 1));
}

TEST(CurvedSurface, ACurvePassesThroughItsPoints) {
    const std::array<glm::dvec3, 3> points{{{0, 0, 0}, {1, 2, 0}, {4, 1, 1}}};
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_LT(glm::distance(on_curve(points, 0.5 * static_cast<double>(i)), points[i]), 1e-12);
    }
}

}  // namespace
}  // namespace lw::scene
