#include "billboard_lod/billboard_plane.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

namespace lw {
namespace {

Camera plain_camera() {
    Camera camera;
    camera.size_px = {200, 100};
    camera.fov = {-2.0, 2.0, -1.0, 1.0};
    return camera;
}

ProjectedBounds bounds_with_ndc(glm::dvec2 low, glm::dvec2 high) {
    ProjectedBounds bounds;
    bounds.ndc_min = low;
    bounds.ndc_max = high;
    bounds.eye_min = {0.0, 0.0, -6.0};
    bounds.eye_max = {0.0, 0.0, -4.0};
    bounds.usable = bounds.visible = true;
    return bounds;
}

TEST(BillboardPlane, ScreenSizeScalesNdcWithTheViewport) {
    const glm::dvec2 size_px = screen_size_px(bounds_with_ndc({-0.125, -0.25}, {0.125, 0.25}), {200, 100});
    EXPECT_DOUBLE_EQ(size_px.x, 25.0);
    EXPECT_DOUBLE_EQ(size_px.y, 25.0);
}

TEST(BillboardPlane, NearestDimensionIsTheDocumentsRule) {
    const auto dimension = [](double side_px) { return kBillboardDimensions[nearest_dimension({side_px, 1.0})]; };
    EXPECT_EQ(dimension(1.0), 16);
    EXPECT_EQ(dimension(23.9), 16);
    EXPECT_EQ(dimension(24.0), 32) << "8 pixels from either: the sharper one";
    EXPECT_EQ(dimension(90.0), 64) << "26 pixels from 64, 38 from 128";
    EXPECT_EQ(dimension(97.0), 128);
    EXPECT_EQ(dimension(5000.0), 512);
}

TEST(BillboardPlane, CoveringDimensionHoldsEveryPixel) {
    const auto dimension = [](double side_px) { return kBillboardDimensions[covering_dimension({1.0, side_px})]; };
    EXPECT_EQ(dimension(16.0), 16);
    EXPECT_EQ(dimension(16.1), 32);
    EXPECT_EQ(dimension(90.0), 128);
    EXPECT_EQ(dimension(513.0), 512);
}

TEST(BillboardPlane, GridLiesOnThePixels) {
    // Tangent per pixel: 4 / 200 = 0.02 across and 2 / 100 = 0.02 upwards.
    const ProjectedBounds bounds = bounds_with_ndc({-0.101, -0.2525}, {0.099, 0.2501});
    const TexelGrid grid = grid_on_pixels(bounds, plain_camera(), 1);
    EXPECT_DOUBLE_EQ(grid.per_texel.x, 0.02);
    EXPECT_DOUBLE_EQ(grid.per_texel.y, 0.02);
    // Tangents -0.202 .. 0.198: pixels 89.9 .. 109.9, so texels 89 .. 110; -0.2525 .. 0.2501: rows 37.495 .. 62.625.
    EXPECT_NEAR(grid.left, -2.0 + 89 * 0.02, 1e-12);
    EXPECT_EQ(grid.size.x, 21);
    EXPECT_NEAR(grid.up, 1.0 - 37 * 0.02, 1e-12);
    EXPECT_EQ(grid.size.y, 26);
}

TEST(BillboardPlane, WithTwoTexelsPerPixelACentreMeetsEveryPixelCentre) {
    const Camera camera = plain_camera();
    const TexelGrid grid = grid_on_pixels(bounds_with_ndc({-0.101, -0.2525}, {0.099, 0.2501}), camera, 2);
    EXPECT_DOUBLE_EQ(grid.per_texel.x, 0.01);
    // The centre of pixel 100 is at tangent 0.01; counted in texels from the grid's edge it is half of something odd.
    const double in_texels = (0.01 - grid.left) / grid.per_texel.x;
    EXPECT_NEAR(in_texels - std::floor(in_texels), 0.5, 1e-9);
    const double down_texels = (grid.up - 0.01) / grid.per_texel.y;
    EXPECT_NEAR(down_texels - std::floor(down_texels), 0.5, 1e-9);
    const FovTangents window = grid.window();
    EXPECT_LE(window.left, -0.202);
    EXPECT_GE(window.right, 0.198);
    EXPECT_LE(window.down, -0.2525);
    EXPECT_GE(window.up, 0.2501);
}

TEST(BillboardPlane, AGridThatDoesNotFitItsSlotHasLargerTexels) {
    const TexelGrid grid = grid_in_slot(bounds_with_ndc({-0.1, -0.3}, {0.1, 0.3}), plain_camera(), 1, 16);
    // 0.4 x 0.6 of tangent in 16 texels a side: 0.0375 each.
    EXPECT_DOUBLE_EQ(grid.per_texel.x, 0.0375);
    EXPECT_DOUBLE_EQ(grid.per_texel.y, 0.0375);
    EXPECT_EQ(grid.size, glm::ivec2(11, 16));
    EXPECT_DOUBLE_EQ(grid.left, -0.2);
    EXPECT_DOUBLE_EQ(grid.up, 0.3);
}

TEST(BillboardPlane, AGridFillsItsSlotWithDenserTexels) {
    // 20 x 30 pixels and a bit: 21 x 31. In 64 texels a side two per pixel, in 128 four, in 32 one.
    const ProjectedBounds bounds = bounds_with_ndc({-0.101, -0.301}, {0.099, 0.299});
    const auto texels_per_px = [&](int max_side) {
        return std::lround(0.02 / grid_in_slot(bounds, plain_camera(), 1, max_side).per_texel.x);
    };
    EXPECT_EQ(texels_per_px(32), 1);
    EXPECT_EQ(texels_per_px(64), 2);
    EXPECT_EQ(texels_per_px(128), 4);
    EXPECT_EQ(texels_per_px(512), kMaxTexelsPerPx) << "and no more than make a difference";
}

TEST(BillboardPlane, LiesAtTheObjectsDistance) {
    // The corrected factor: on the near plane n the centre is (x n, y n, -n); times e = d_cc / P_z it is at -d_cc.
    const BillboardPlane plane = plane_of({0.1, 0.5, -0.2, 0.4}, 10.0);
    EXPECT_DOUBLE_EQ(plane.centre_eye.x, 3.0);
    EXPECT_DOUBLE_EQ(plane.centre_eye.y, 1.0);
    EXPECT_DOUBLE_EQ(plane.centre_eye.z, -10.0);
    EXPECT_DOUBLE_EQ(plane.half_width_m, 2.0);
    EXPECT_DOUBLE_EQ(plane.half_height_m, 3.0);
}

TEST(BillboardPlane, CorrectedDistanceKeepsTheReliefAndMovesThePlane) {
    EXPECT_DOUBLE_EQ(corrected_distance_m(10.0, 9.5, 10.0), 9.5) << "nothing moved";
    EXPECT_DOUBLE_EQ(corrected_distance_m(8.0, 9.5, 10.0), 7.5) << "two metres nearer";
    EXPECT_DOUBLE_EQ(corrected_distance_m(12.0, 10.25, 10.0), 12.25);
}

}  // namespace
}  // namespace lw
