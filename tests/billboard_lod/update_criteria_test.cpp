#include "billboard_lod/update_criteria.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace lw {
namespace {

constexpr double kDeg = 3.14159265358979323846 / 180.0;

Camera plain_camera() {
    Camera camera;
    camera.size_px = {1000, 1000};
    camera.fov = {-1.0, 1.0, -1.0, 1.0};
    return camera;
}

/// 0.2 x 0.2 of tangent about the axis, 9 to 11 m away, one texel per pixel.
DrawnBillboard ahead() { return {{-0.1, 0.1, glm::dvec2{0.002}, {100, 100}}, 9.0, 11.0, 10.0}; }

/// eye_now_from_eye_drawn of an eye that moved by `step_m`.
glm::dmat4 moved(const glm::dvec3& step_m) { return glm::translate(glm::dmat4{1.0}, -step_m); }

TEST(UpdateCriteria, ViewAngleIsThatBetweenTheHorizontals) {
    EXPECT_NEAR(view_angle_deg({2.0, 0.0, 0.0}, {std::cos(2.5 * kDeg), 0.0, std::sin(2.5 * kDeg)}), 2.5, 1e-12);
    EXPECT_NEAR(view_angle_deg({1.0, 0.0, 0.0}, {-3.0, 0.0, 0.0}), 180.0, 1e-12);
    EXPECT_NEAR(view_angle_deg({1.0, 0.0, 0.0}, {1.0, 1e-9, 0.0}), 1e-9 / kDeg, 1e-18) << "tiny angles are not lost";
}

TEST(UpdateCriteria, LateralAngleIsThatBetweenTheWaysToTheCentre) {
    // 10 m away, the eye steps 1 m to the side.
    EXPECT_NEAR(lateral_angle_deg({0.0, 0.0, -10.0}, {-1.0, 0.0, -10.0}), std::atan(0.1) / kDeg, 1e-12);
    EXPECT_EQ(lateral_angle_deg({0.0, 0.0, -10.0}, {0.0, 0.0, -5.0}), 0.0) << "straight ahead";
}

TEST(UpdateCriteria, DistanceScoreIsScaledTo180) {
    EXPECT_NEAR(distance_score({0.0, 0.0, -10.25}, {0.0, 0.0, -10.0}), 4.5, 1e-12) << "2.5 %";
    EXPECT_NEAR(distance_score({0.0, 0.0, -10.0}, {0.0, 0.0, -20.0}), 90.0, 1e-12) << "further away: half";
    EXPECT_EQ(distance_score({0.0, 0.0, -10.0}, {0.0, 0.0, -1.0}), 180.0) << "clamped";
}

TEST(UpdateCriteria, TheSumOfSharesDecides) {
    const UpdateThresholds thresholds;
    EXPECT_DOUBLE_EQ((UpdateScores{2.5, 0.0, 0.0}.weighted(thresholds)), 1.0);
    EXPECT_DOUBLE_EQ((UpdateScores{0.0, 1.0, 0.0}.weighted(thresholds)), 1.0);
    EXPECT_DOUBLE_EQ((UpdateScores{0.0, 0.0, 4.5}.weighted(thresholds)), 1.0);
    EXPECT_DOUBLE_EQ((UpdateScores{1.25, 0.25, 1.125}.weighted(thresholds)), 1.0) << "three weak ones together";
}

TEST(UpdateCriteria, FromWhereItWasDrawnNothingIsWrong) {
    EXPECT_NEAR(flat_error_px(ahead(), glm::dmat4{1.0}, plain_camera()), 0.0, 1e-9);
    EXPECT_NEAR(warped_error_px(ahead(), glm::dmat4{1.0}, plain_camera()), 0.0, 1e-9);
}

TEST(UpdateCriteria, ASidestepShowsTheDepthOfTheRelief) {
    // By 0.1 m. The plane is right at 10 m; a point at 9 m belongs 500 * 0.1 * (1/9 - 1/10) = 0.556 px from where the
    // quad shows it.
    const double flat_px = flat_error_px(ahead(), moved({0.1, 0.0, 0.0}), plain_camera());
    EXPECT_NEAR(flat_px, 500.0 * 0.1 * (1.0 / 9.0 - 1.0 / 10.0), 1e-9);
    // Warped nothing is misplaced; between 9 m and 11 m a gap opens, between two points in there a third of it.
    const double warped_px = warped_error_px(ahead(), moved({0.1, 0.0, 0.0}), plain_camera());
    EXPECT_NEAR(warped_px, 500.0 * 0.1 * (1.0 / 9.0 - 1.0 / 11.0) / 3.0, 1e-9);
}

TEST(UpdateCriteria, ATurnOfTheHeadIsFreeForAWarpedBillboard) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4{1.0}, 10.0 * kDeg, glm::dvec3{0.0, 1.0, 0.0});
    EXPECT_NEAR(warped_error_px(ahead(), turned, plain_camera()), 0.0, 0.02 * 10.0);
    EXPECT_GT(flat_error_px(ahead(), turned, plain_camera()), 1.0);
}

TEST(UpdateCriteria, ComingNearerMakesTexelsLargerThanPixels) {
    // From 10 m to 5 m: the nearest point is 4 m away, so a texel is 9 / 4 px wide, and relief opens gaps at the edge
    // of the window, 0.1 off the axis: a third of 500 * 0.1 * (9/4 - 11/6) px along both axes.
    const double error_px = warped_error_px(ahead(), moved({0.0, 0.0, -5.0}), plain_camera());
    EXPECT_NEAR(error_px, std::sqrt(2.0) * 500.0 * 0.1 * (9.0 / 4.0 - 11.0 / 6.0) / 3.0 + (9.0 / 4.0 - 1.0), 1e-9);
}

TEST(UpdateCriteria, ABillboardAcrossTheNearPlaneIsInfinitelyWrong) {
    EXPECT_TRUE(std::isinf(flat_error_px(ahead(), moved({0.0, 0.0, -9.96}), plain_camera())));
    EXPECT_TRUE(std::isinf(warped_error_px(ahead(), moved({0.0, 0.0, -8.96}), plain_camera())));
    EXPECT_TRUE(std::isinf(warped_error_px(ahead(), moved({0.0, 0.0, -20.0}), plain_camera())));
}

}  // namespace
}  // namespace lw
