#include "scene/solid_boxes.h"

#include <gtest/gtest.h>

#include "scene/mesh_builder.h"

namespace lw::scene {
namespace {

double volume(const Bounds& box) {
    const glm::dvec3 size = box.max - box.min;
    return size.x * size.y * size.z;
}

Mesh box_mesh(unsigned sides) {
    MeshBuilder builder{"box"};
    builder.use_material(0);
    builder.box({-1.0, 0.0, -2.0}, {1.0, 3.0, 2.0}, sides);
    return builder.take();
}

TEST(SolidBoxes, AClosedBoxIsSolidToItsSurface) {
    const auto boxes = solid_boxes(box_mesh(kAllSides), {Material{}});
    ASSERT_FALSE(boxes.empty());
    EXPECT_EQ(boxes[0].open_sides, 0U);
    EXPECT_NEAR(volume(boxes[0].box_object), 24.0, 1e-5) << "it grows until it touches all six sides";
}

TEST(SolidBoxes, AMissingSideIsSaidToBeOpen) {
    const auto boxes = solid_boxes(box_mesh(kNoBottom), {Material{}});
    ASSERT_FALSE(boxes.empty());
    EXPECT_EQ(boxes[0].open_sides, 1U << 2);
    EXPECT_NEAR(volume(boxes[0].box_object), 24.0, 1e-5);
}

TEST(SolidBoxes, WhatLetsLightThroughIsNotSolid) {
    EXPECT_TRUE(solid_boxes(box_mesh(kLeft | kRight | kTop), {Material{}}).empty()) << "a tunnel";
    Material leaves;
    leaves.alpha_cutoff = 0.5F;
    EXPECT_TRUE(solid_boxes(box_mesh(kAllSides), {leaves}).empty()) << "holes may be anywhere in a masked texture";
    Mesh inside_out = box_mesh(kAllSides);
    for (std::size_t i = 0; i < inside_out.indices.size(); i += 3) {
        std::swap(inside_out.indices[i], inside_out.indices[i + 1]);
    }
    for (const SolidBox& box : solid_boxes(inside_out, {Material{}})) {
        EXPECT_EQ(box.open_sides, 63U) << "its faces are not drawn from outside";
    }
}

TEST(SolidBoxes, AHoleInASideOpensIt) {
    // The right wall is four strips around a window of a tenth of its area.
    MeshBuilder builder{"box with a window"};
    builder.use_material(0);
    builder.box({-1.0, 0.0, -2.0}, {1.0, 3.0, 2.0}, kAllSides & ~static_cast<unsigned>(kRight));
    const auto wall = [&](double y0, double y1, double z0, double z1) {
        builder.polygon({{1.0, y0, z1}, {1.0, y0, z0}, {1.0, y1, z0}, {1.0, y1, z1}});
    };
    wall(0.0, 1.0, -2.0, 2.0);
    wall(2.0, 3.0, -2.0, 2.0);
    wall(1.0, 2.0, -2.0, -0.6);
    wall(1.0, 2.0, 0.6, 2.0);
    for (const SolidBox& box : solid_boxes(builder.take(), {Material{}})) {
        EXPECT_NE(box.open_sides & (1U << 1), 0U) << "what enters through the window is not hidden";
    }
}

TEST(SolidBoxes, BoxesLieInsideARoundBody) {
    MeshBuilder builder{"barrel"};
    builder.use_material(0);
    builder.lathe({0.0, 0.0, 0.0}, {{0.0, 0.0}, {1.0, 0.0}, {1.0, 2.0}, {0.0, 2.0}}, 24);
    const auto boxes = solid_boxes(builder.take(), {Material{}});
    ASSERT_FALSE(boxes.empty());
    for (const SolidBox& solid : boxes) {
        for (int corner = 0; corner < 4; ++corner) {
            const double x = (corner & 1) != 0 ? solid.box_object.min.x : solid.box_object.max.x;
            const double z = (corner & 2) != 0 ? solid.box_object.min.z : solid.box_object.max.z;
            EXPECT_LE(x * x + z * z, 1.0 + 1e-9);
        }
    }
    EXPECT_GT(volume(boxes[0].box_object), 0.8 * 4.0) << "the largest box in the cylinder has a volume of 4";
}

}  // namespace
}  // namespace lw::scene
