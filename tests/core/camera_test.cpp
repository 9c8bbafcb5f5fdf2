#include "core/camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/camera_picture.h"

namespace lw {
namespace {

constexpr double kPi = std::numbers::pi;

Camera asymmetric_camera() {
    Camera camera;
    camera.fov = {-0.8, 1.2, -0.5, 1.5};
    camera.near_m = 0.1;
    camera.size_px = {200, 100};
    return camera;
}

// Pixel position and depth of a point in eye space, through the project's own target matrices.
glm::dvec3 project(const Camera& camera, const glm::dvec3& position_eye) {
    const auto target_px_from_target_eye = target_px_from_target_clip(camera) * target_clip_from_target_eye(camera);
    const glm::dvec4 h = target_px_from_target_eye.matrix * glm::dvec4{position_eye, 1.0};
    return glm::dvec3{h} / h.w;
}

TEST(Camera, SymmetricFieldOfView) {
    const FovTangents fov = FovTangents::symmetric(kPi / 2, 2.0);
    EXPECT_NEAR(fov.up, 1.0, 1e-15);
    EXPECT_NEAR(fov.down, -1.0, 1e-15);
    EXPECT_NEAR(fov.left, -2.0, 1e-15);
    EXPECT_NEAR(fov.right, 2.0, 1e-15);
}

TEST(Camera, CornersOfTheImageLookAlongTheTangents) {
    const Camera camera = asymmetric_camera();
    const glm::dmat4 m = source_eye_from_source_px(camera).matrix;
    const glm::dvec4 top_left = m * glm::dvec4{0, 0, 1, 0.5};
    const glm::dvec4 bottom_right = m * glm::dvec4{200, 100, 1, 0.0};
    EXPECT_NEAR(top_left.x, -0.8, 1e-15);
    EXPECT_NEAR(top_left.y, 1.5, 1e-15);  // row 0 is the top
    EXPECT_EQ(top_left.z, -1.0);
    EXPECT_NEAR(top_left.w, 0.5 / 0.1, 1e-15);
    EXPECT_NEAR(bottom_right.x, 1.2, 1e-15);
    EXPECT_NEAR(bottom_right.y, -0.5, 1e-15);
    EXPECT_EQ(bottom_right.w, 0.0) << "background is a direction";
}

TEST(Camera, DepthIsOneAtTheNearPlaneAndZeroAtInfinity) {
    const Camera camera = asymmetric_camera();
    EXPECT_NEAR(project(camera, {0, 0, -0.1}).z, 1.0, 1e-15);
    EXPECT_NEAR(project(camera, {0.3, 0.2, -2.0}).z, 0.05, 1e-15);
    EXPECT_LT(project(camera, {0, 0, -1e12}).z, 1e-12);
    EXPECT_NEAR(distance_m(0.05, camera.near_m), 2.0, 1e-15);
    EXPECT_TRUE(std::isinf(distance_m(0.0, camera.near_m)));
}

TEST(Camera, SourcePixelsProjectBackToThemselves) {
    const Camera camera = asymmetric_camera();
    for (const double depth : {1.0, 0.3, 1e-4}) {
        for (const double x_px : {0.0, 17.5, 100.0, 199.5}) {
            for (const double y_px : {0.5, 42.0, 99.5}) {
                const glm::dvec4 h = source_eye_from_source_px(camera).matrix * glm::dvec4{x_px, y_px, 1.0, depth};
                const glm::dvec3 back = project(camera, glm::dvec3{h} / h.w);
                // 1e-11: double rounding of values up to 200, a dozen operations.
                EXPECT_NEAR(back.x, x_px, 1e-11);
                EXPECT_NEAR(back.y, y_px, 1e-11);
                EXPECT_NEAR(back.z, depth, 1e-14);
            }
        }
    }
}

TEST(Camera, TheAxisOfAnAsymmetricViewIsNotItsCentre) {
    const glm::dvec3 axis = project(asymmetric_camera(), {0, 0, -3});
    EXPECT_NEAR(axis.x, 200 * 0.8 / 2.0, 1e-12);
    EXPECT_NEAR(axis.y, 100 * 1.5 / 2.0, 1e-12);
}

TEST(Camera, DepthIsAffineInPixelsOnAPlane) {
    // Plane y = -1 + 0.2 x: three points on a line in the image have depths with no second difference.
    const Camera camera = asymmetric_camera();
    const glm::dmat4 m = source_eye_from_source_px(camera).matrix;
    const auto depth_at = [&](double x_px, double y_px) {
        const glm::dvec4 ray = m * glm::dvec4{x_px, y_px, 1, 0};
        const double distance = -1.0 / (ray.y - 0.2 * ray.x);  // ray * distance lies on the plane
        return camera.near_m / distance;
    };
    EXPECT_NEAR(depth_at(50, 90) - 2.0 * depth_at(60, 92) + depth_at(70, 94), 0.0, 1e-15);
}

TEST(Camera, PixelsPerDegreeAtTheImageCentre) {
    Camera camera;
    camera.size_px = {1024, 1024};
    camera.fov = FovTangents::symmetric(kPi / 2, 1.0);
    EXPECT_NEAR(pixels_per_degree(camera), kPi / 180.0 * 512.0, 1e-12);  // 8.94
}

TEST(CameraPicture, CornersAreTheTangentsTurnedWithTheEye) {
    const Camera camera = asymmetric_camera();
    EXPECT_EQ(pixel_count(camera), 20000.0);
    EXPECT_EQ(direction_at(camera, 0.0, 0.0), glm::dvec3(-0.8, 1.5, -1.0));
    EXPECT_EQ(direction_at(camera, 1.0, 1.0), glm::dvec3(1.2, -0.5, -1.0));
    const Pose to_the_left{{1.0, 2.0, 3.0}, glm::angleAxis(kPi / 2, glm::dvec3{0.0, 1.0, 0.0})};
    const Camera turned = at_pose(camera, to_the_left);
    EXPECT_EQ(turned.world_from_eye, to_the_left);
    EXPECT_EQ(turned.fov, camera.fov);
    EXPECT_LT(glm::distance(direction_at(turned, 0.0, 0.0), glm::dvec3(-1.0, 1.5, 0.8)), 1e-12);
}

TEST(CameraPicture, SeesWhatItsTangentsHold) {
    const Camera camera = asymmetric_camera();
    EXPECT_TRUE(sees(camera, {-0.79, 1.49, -1.0}));
    EXPECT_TRUE(sees(camera, {-7.9, 14.9, -10.0})) << "of any length";
    EXPECT_FALSE(sees(camera, {-0.81, 0.0, -1.0}));
    EXPECT_FALSE(sees(camera, {0.0, -0.51, -1.0}));
    EXPECT_FALSE(sees(camera, {0.0, 0.0, 1.0})) << "behind the eye";
}

}  // namespace
}  // namespace lw
