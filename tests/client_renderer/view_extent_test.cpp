// How far a view reaches: beyond the display where the eye is expected to look, and nowhere else.
#include "client_renderer/view_extent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "client_renderer/guard_band.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Pose turned(double yaw_degrees, const glm::dvec3& position_m = {}) {
    return {position_m, glm::angleAxis(yaw_degrees * kDegree, glm::dvec3{0.0, 1.0, 0.0})};
}

class ViewExtentTest : public ::testing::Test {
protected:
    Camera display_ = test::plain_camera({512, 512});
};

TEST_F(ViewExtentTest, AStillEyeNeedsTheDisplayAndItsPixelsCoincide) {
    EXPECT_EQ(needed_extent(display_, {}), ViewExtent{});
    EXPECT_EQ(extended(display_, {}), display_);
    const Camera view = extended(display_, {16, 0, 8, 32});
    EXPECT_EQ(view.size_px, (glm::ivec2{528, 552}));
    const double tan_per_px = (display_.fov.right - display_.fov.left) / 512;
    EXPECT_DOUBLE_EQ(view.fov.left, display_.fov.left - 16 * tan_per_px);
    EXPECT_DOUBLE_EQ(view.fov.right, display_.fov.right);
}

// The left edge of a display turned left by 5 degrees is 5 degrees beyond that of the view.
TEST_F(ViewExtentTest, ATurnNeedsTheSideThatItLeadsTo) {
    const ViewExtent extent = needed_extent(display_, {turned(0.0), turned(0.0), turned(5.0), 1.0});
    const double beyond = std::tan(std::atan(-display_.fov.left) + 5.0 * kDegree) + display_.fov.left;
    const double tan_per_px = (display_.fov.right - display_.fov.left) / 512;
    EXPECT_EQ(extent.left_px, static_cast<int>(std::ceil(beyond / tan_per_px)));
    EXPECT_EQ(extent.right_px, 0);
    EXPECT_EQ(extent.up_px, extent.down_px) << "the edge that comes nearer looks higher";
}

// A step of 0.1 m to the right shows what is 2 m away by 0.05 of the tangent beyond the right edge.
TEST_F(ViewExtentTest, AStepNeedsWhatIsNear) {
    const ViewMotion motion{turned(0.0), turned(0.0), turned(0.0, {0.1, 0.0, 0.0}), 2.0};
    const double tan_per_px = (display_.fov.right - display_.fov.left) / 512;
    const ViewExtent extent = needed_extent(display_, motion);
    EXPECT_EQ(extent, (ViewExtent{0, static_cast<int>(std::ceil(0.05 / tan_per_px - 1e-6)), 0, 0}));
}

TEST_F(ViewExtentTest, AHeadThatTurnsRoundEndsAtTheWidestAngle) {
    const ViewExtent extent = needed_extent(display_, {turned(0.0), turned(0.0), turned(170.0), 1.0});
    const Camera view = extended(display_, extent);
    const double tan_per_px = (display_.fov.right - display_.fov.left) / 512;
    EXPECT_NEAR(view.fov.left, -std::tan(kWidestHalfAngleRad), tan_per_px);
}

TEST_F(ViewExtentTest, SidesGrowAtOnceAndShrinkSeldom) {
    const ViewExtent trembling = next_extent(display_, {turned(0.0), turned(0.0), turned(0.05), 1.0}, {});
    EXPECT_EQ(trembling, ViewExtent{});
    const ViewExtent grown = next_extent(display_, {turned(0.0), turned(0.0), turned(4.0), 1.0}, {});
    EXPECT_GT(grown.left_px, 0);
    EXPECT_EQ(grown.left_px % 16, 0);
    EXPECT_EQ(next_extent(display_, {turned(0.0), turned(0.0), turned(3.5), 1.0}, grown).left_px, grown.left_px);
    EXPECT_LT(next_extent(display_, {turned(0.0), turned(0.0), turned(1.0), 1.0}, grown).left_px, grown.left_px);
    EXPECT_EQ(next_extent(display_, {}, grown), ViewExtent{}) << "a still head's view is the display";
}

TEST_F(ViewExtentTest, AShareOfItIsNoWider) {
    EXPECT_EQ((ViewExtent{9, 3, 0, 1}.scaled(0.5)), (ViewExtent{4, 1, 0, 0}));
}

}  // namespace
}  // namespace lw
