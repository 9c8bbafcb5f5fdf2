#include "scene/mesh_builder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/random.h"

namespace lw::scene {
namespace {

/// Six times the signed volume that a closed mesh encloses: positive when its fronts face out.
double six_volumes(const Mesh& mesh) {
    double sum = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a{mesh.vertices[mesh.indices[i]].position_object};
        const glm::dvec3 b{mesh.vertices[mesh.indices[i + 1]].position_object};
        const glm::dvec3 c{mesh.vertices[mesh.indices[i + 2]].position_object};
        sum += glm::dot(a, glm::cross(b, c));
    }
    return sum;
}

/// Smallest dot product of a triangle's geometric normal and its vertices' normals.
double worst_agreement(const Mesh& mesh) {
    double worst = 1.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vertex& a = mesh.vertices[mesh.indices[i]];
        const Vertex& b = mesh.vertices[mesh.indices[i + 1]];
        const Vertex& c = mesh.vertices[mesh.indices[i + 2]];
        const glm::vec3 normal =
            glm::normalize(glm::cross(b.position_object - a.position_object, c.position_object - a.position_object));
        for (const Vertex* v : {&a, &b, &c}) worst = std::min<double>(worst, glm::dot(normal, v->normal_object));
    }
    return worst;
}

TEST(MeshBuilder, ABoxHasItsVolumeAndSharesVerticesInsideFaces) {
    MeshBuilder builder{"box"};
    builder.use_material(0);
    builder.box({-1.0, 0.0, 2.0}, {1.0, 3.0, 4.0});
    const Mesh mesh = builder.take();
    EXPECT_EQ(mesh.vertices.size(), 24u);
    EXPECT_EQ(mesh.indices.size(), 36u);
    EXPECT_DOUBLE_EQ(six_volumes(mesh), 6.0 * 12.0);
    EXPECT_GT(worst_agreement(mesh), 0.999999);  // float normals of axis-aligned faces
    EXPECT_EQ(mesh.bounds.min, glm::dvec3(-1.0, 0.0, 2.0));
    EXPECT_EQ(mesh.bounds.max, glm::dvec3(1.0, 3.0, 4.0));
}

TEST(MeshBuilder, PlacementTurnsCounterClockwiseFromAboveAndKeepsFrontsOutside) {
    MeshBuilder builder{"turned"};
    builder.use_material(0);
    builder.place(placement({10.0, 0.0, 0.0}, 0.25));
    builder.box({0.0, 0.0, 0.0}, {2.0, 1.0, 0.5});
    const Mesh mesh = builder.take();
    // Local +x becomes world -z, local +z becomes +x.
    EXPECT_NEAR(mesh.bounds.min.z, -2.0, 1e-6);  // float positions
    EXPECT_NEAR(mesh.bounds.max.x, 10.5, 1e-6);
    EXPECT_NEAR(six_volumes(mesh), 6.0, 1e-4);
}

TEST(MeshBuilder, BeamsBarsAndLathesFaceOutside) {
    MeshBuilder builder{"solids"};
    builder.use_material(0);
    builder.beam({0.0, 0.0, 0.0}, {1.0, 2.0, -2.0}, 0.2, 0.1);
    const Mesh beam = builder.take();
    EXPECT_NEAR(six_volumes(beam), 6.0 * 3.0 * 0.2 * 0.1, 1e-5);

    MeshBuilder bars{"bar"};
    bars.use_material(0);
    bars.bar({0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0.01, 4);
    bars.bar({0.0, 0.0, 0.0}, {0.3, 0.0, 1.0}, 0.01, 3);
    EXPECT_EQ(bars.triangle_count(), 14u);
    const Mesh bar = bars.take();
    EXPECT_EQ(bar.vertices.size(), 14u);
    EXPECT_GT(worst_agreement(bar), 0.49);  // corners of a triangular bar lean 60 degrees from its faces

    MeshBuilder turned{"lathe"};
    turned.use_material(0);
    turned.lathe({0.0, 0.0, 0.0}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}, {0.0, 2.0}}, 64, true);
    const Mesh cylinder = turned.take();
    // A 64-gon has 0.16 % less area than the circle.
    EXPECT_NEAR(six_volumes(cylinder), 6.0 * 2.0 * 3.14159265, 6.0 * 2.0 * 3.14159265 * 0.002);
    EXPECT_GT(worst_agreement(cylinder), 0.99);  // facets lean 2.8 degrees from the smooth normals
}

TEST(MeshBuilder, TextureCoordinatesAreMetresAndContinueOverNeighbours) {
    MeshBuilder builder{"wall"};
    builder.use_material(0, 2.0);
    builder.polygon({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.0}});
    builder.polygon({{1.0, 0.0, 0.0}, {3.0, 0.0, 0.0}, {3.0, 1.0, 0.0}, {1.0, 1.0, 0.0}});
    const Mesh mesh = builder.take();
    EXPECT_EQ(mesh.vertices[1].uv, mesh.vertices[4].uv);
    EXPECT_FLOAT_EQ(mesh.vertices[5].uv.x - mesh.vertices[4].uv.x, 1.0f);   // 2 m to the right, one repeat
    EXPECT_FLOAT_EQ(mesh.vertices[2].uv.y - mesh.vertices[1].uv.y, -0.5f);  // 1 m up
}

TEST(MeshBuilder, MaterialsBecomePrimitivesAndEmptyShapesVanish) {
    MeshBuilder builder{"two"};
    builder.use_material(3);
    builder.box({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
    builder.use_material(1);
    builder.polygon({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}});
    builder.use_material(2);
    builder.polygon({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}});  // no area
    const Mesh mesh = builder.take();
    ASSERT_EQ(mesh.primitives.size(), 2u);
    EXPECT_EQ(mesh.primitives[0].material, 1);
    EXPECT_EQ(mesh.primitives[0].index_count, 3u);
    EXPECT_EQ(mesh.primitives[1].material, 3);
    EXPECT_EQ(mesh.primitives[1].first_index, 3u);
}

TEST(Random, DirectionsAreOnTheCircle) {
    for (int i = -400; i <= 400; ++i) {
        const double turns = i * 0.01;
        const Direction2 d = direction_of_turns(turns);
        // The argument alone is rounded to 3e-15 rad at 25 rad.
        EXPECT_NEAR(d.cosine, std::cos(turns * 6.283185307179586), 1e-14) << turns;
        EXPECT_NEAR(d.sine, std::sin(turns * 6.283185307179586), 1e-14) << turns;
    }
}

TEST(Random, KnownNumbers) {
    Random random{0};
    // splitmix64 of seed 0, as its authors publish it.
    EXPECT_EQ(random.bits(), 0xE220A8397B1DCDAFull);
    EXPECT_EQ(random.bits(), 0x6E789E6AA1B965F4ull);
    for (int i = 0; i < 1000; ++i) {
        const double unit = random.unit();
        EXPECT_GE(unit, 0.0);
        EXPECT_LT(unit, 1.0);
        const int below = random.below(7);
        EXPECT_GE(below, 0);
        EXPECT_LT(below, 7);
    }
}

TEST(MeshBuilder, AStripMeetsAllCornersOfBothItsSides) {
    MeshBuilder builder{"strip"};
    builder.use_material(0);
    const glm::dvec3 front{0.0, 0.0, 1.0};
    std::vector<std::uint32_t> left;
    std::vector<std::uint32_t> right;
    for (const double y : {0.0, 3.0}) left.push_back(builder.vertex({0.0, y, 0.0}, front));
    for (const double y : {0.0, 1.0, 1.5, 3.0}) right.push_back(builder.vertex({2.0, y, 0.0}, front));
    builder.strip(left, right);
    const Mesh mesh = builder.take();
    EXPECT_EQ(mesh.vertices.size(), 6U);
    ASSERT_EQ(mesh.indices.size(), 3U * 4U);
    double area = 0.0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a{mesh.vertices[mesh.indices[i]].position_object};
        const glm::dvec3 b{mesh.vertices[mesh.indices[i + 1]].position_object};
        const glm::dvec3 c{mesh.vertices[mesh.indices[i + 2]].position_object};
        const double twice = glm::cross(b - a, c - a).z;
        EXPECT_GT(twice, 0.0) << "a triangle faces back";
        area += 0.5 * twice;
    }
    EXPECT_NEAR(area, 6.0, 1e-6);
}

}  // namespace
}  // namespace lw::scene
