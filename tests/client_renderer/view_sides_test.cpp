#include "client_renderer/view_sides.h"

#include <gtest/gtest.h>

#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

class ViewSidesTest : public ::testing::Test {
protected:
    static Pose turned(double turn_rad, const glm::dvec3& position_m = {}) {
        return {position_m, glm::angleAxis(turn_rad, glm::dvec3{0.0, 1.0, 0.0})};
    }
    Camera at(const Pose& pose) const {
        Camera camera = display_;
        camera.world_from_eye = pose;
        return camera;
    }

    Camera display_ = test::plain_camera({100, 80});
};

TEST_F(ViewSidesTest, BesideAWholePictureEachSideIsHalfOfTheView) {
    const Camera left = side_of(display_, ViewSide::left, display_, 2.0);
    const Camera right = side_of(display_, ViewSide::right, display_, 2.0);
    EXPECT_EQ(left.size_px, glm::ivec2(50, 80));
    EXPECT_EQ(right.size_px, glm::ivec2(50, 80));
    EXPECT_EQ(left.fov.left, display_.fov.left);
    EXPECT_EQ(right.fov.right, display_.fov.right);
    EXPECT_NEAR(left.fov.right, right.fov.left, 1e-12);
    EXPECT_EQ(side_of(display_, ViewSide::whole, left, 2.0), display_);
}

TEST_F(ViewSidesTest, ASideReachesToTheEdgeOfTheOtherWhereverThatIsNow) {
    const Camera right = side_of(display_, ViewSide::right, display_, 2.0);
    for (const double turn_rad : {-0.05, 0.0, 0.05}) {
        const Pose now = turned(turn_rad, {0.02, 0.01, 0.0});
        const Camera whole = at(now);
        const Camera left = side_of(whole, ViewSide::left, right, 2.0);
        EXPECT_GE(left.size_px.x, 50);
        // The head that turns to the left no longer needs the right edge, the other one sees past it.
        const double open = share_left_open(whole, left, right, display_, {&now, 1});
        EXPECT_EQ(open > 0.0, turn_rad < 0.0) << turn_rad;
    }
}

TEST_F(ViewSidesTest, AStepMovesTheSeamOfWhatIsNear) {
    const Camera right = side_of(display_, ViewSide::right, display_, 1.0);
    const Camera far = side_of(at(turned(0.0, {-0.1, 0.0, 0.0})), ViewSide::left, right, 100.0);
    const Camera near = side_of(at(turned(0.0, {-0.1, 0.0, 0.0})), ViewSide::left, right, 1.0);
    EXPECT_NEAR(near.size_px.x - far.size_px.x, 0.1 * 80 / 2, 1.0) << "a tenth of the distance, at 40 px per tangent";
}

TEST_F(ViewSidesTest, WhatNeitherShowsIsCounted) {
    const Camera left = side_of(display_, ViewSide::left, display_, 2.0);
    const Pose now;
    EXPECT_DOUBLE_EQ(share_left_open(display_, left, left, display_, {&now, 1}), 0.5);
    EXPECT_DOUBLE_EQ(share_left_open(display_, left, display_, display_, {&now, 1}), 0.0);
}

TEST_F(ViewSidesTest, AHeadGoesOnAsItDid) {
    const Pose later = gone_on(turned(0.1, {1.0, 0.0, 0.0}), turned(0.3, {1.5, 0.0, 0.0}));
    EXPECT_NEAR(glm::distance(later.position_m, glm::dvec3{2.0, 0.0, 0.0}), 0.0, 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(later.orientation, turned(0.5).orientation)), 1.0, 1e-12);
}

}  // namespace
}  // namespace lw
