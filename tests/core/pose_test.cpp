#include "core/pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lw {
namespace {

constexpr double kPi = std::numbers::pi;

Pose turned(double angle_rad, glm::dvec3 axis, glm::dvec3 position_m = {}) {
    return {position_m, glm::angleAxis(angle_rad, glm::normalize(axis))};
}

TEST(Pose, SanitisedNormalisesAndKeepsUnitQuaternionsBitForBit) {
    const Pose unit = turned(0.7, {1, 2, 3}, {1, 2, 3});
    EXPECT_EQ(*sanitised(unit), unit);
    Pose scaled = unit;
    scaled.orientation = unit.orientation * 3.0;
    ASSERT_TRUE(sanitised(scaled));
    EXPECT_NEAR(glm::length(sanitised(scaled)->orientation), 1.0, 1e-15);
    EXPECT_LT(angle_between_rad(sanitised(scaled)->orientation, unit.orientation), 1e-15);
}

TEST(Pose, SanitisedRefusesWhatHasNoDirection) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(sanitised({{0, 0, 0}, {0, 0, 0, 0}}));
    EXPECT_FALSE(sanitised({{0, 0, 0}, {1e-7, 0, 0, 0}}));
    EXPECT_FALSE(sanitised({{0, nan, 0}, {1, 0, 0, 0}}));
    EXPECT_FALSE(sanitised({{0, 0, 0}, {1, nan, 0, 0}}));
    EXPECT_FALSE(sanitised({{infinity, 0, 0}, {1, 0, 0, 0}}));
    EXPECT_TRUE(sanitised({{0, 0, 0}, {1e160, 1e160, 0, 0}})) << "the norm does not overflow";
}

TEST(Pose, MatrixAndInverseMatrixCancel) {
    const Pose pose = turned(1.1, {0.3, -1, 0.2}, {4, 5, 6});
    const glm::dmat4 product = inverse_matrix_of(pose) * matrix_of(pose);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) EXPECT_NEAR(product[column][row], column == row ? 1.0 : 0.0, 1e-14);
    }
}

TEST(Pose, AQuarterTurnToTheLeftLooksAlongMinusX) {
    const glm::dvec4 ahead = matrix_of(turned(kPi / 2, {0, 1, 0}, {10, 0, 0})) * glm::dvec4{0, 0, -1, 1};
    EXPECT_NEAR(ahead.x, 9.0, 1e-14);
    EXPECT_NEAR(ahead.z, 0.0, 1e-14);
}

TEST(Pose, InterpolationMovesOnTheSphereAtConstantSpeed) {
    const Pose a = turned(0.2, {0, 1, 0});
    const Pose b = turned(0.2 + 2.0, {0, 1, 0}, {8, 0, 0});
    for (const double t : {0.0, 0.1, 0.25, 0.5, 0.9, 1.0}) {
        const Pose pose = interpolate(a, b, t);
        EXPECT_NEAR(angle_between_rad(a.orientation, pose.orientation), 2.0 * t, 1e-14);
        EXPECT_NEAR(pose.position_m.x, 8.0 * t, 1e-14);
        EXPECT_NEAR(glm::length(pose.orientation), 1.0, 1e-15);
    }
}

TEST(Pose, InterpolationExtrapolatesOutsideOfItsEnds) {
    const Pose a = turned(0.0, {0, 0, 1});
    const Pose b = turned(0.3, {0, 0, 1}, {0, 1, 0});
    EXPECT_LT(angle_between_rad(interpolate(a, b, 3.0).orientation, turned(0.9, {0, 0, 1}).orientation), 1e-14);
    EXPECT_LT(angle_between_rad(interpolate(a, b, -1.0).orientation, turned(-0.3, {0, 0, 1}).orientation), 1e-14);
    EXPECT_NEAR(interpolate(a, b, 3.0).position_m.y, 3.0, 1e-15);
}

TEST(Pose, InterpolationTakesTheShorterArcBetweenOppositeSigns) {
    const Pose a = turned(0.1, {0, 1, 0});
    Pose b = turned(0.3, {0, 1, 0});
    b.orientation = -b.orientation;  // the same rotation
    EXPECT_LT(angle_between_rad(interpolate(a, b, 0.5).orientation, turned(0.2, {0, 1, 0}).orientation), 1e-14);
}

TEST(Pose, AnglesBelowTheReachOfTheCosineAreExact) {
    for (const double angle_rad : {1e-6, 1e-9, 1e-12}) {
        const Pose b = turned(angle_rad, {1, 1, 0});
        EXPECT_NEAR(angle_between_rad(Pose{}.orientation, b.orientation) / angle_rad, 1.0, 1e-9);
        EXPECT_NEAR(angle_between_rad(Pose{}.orientation, interpolate(Pose{}, b, 0.5).orientation) / angle_rad, 0.5,
                    1e-9);
    }
    EXPECT_EQ(angle_between_rad(Pose{}.orientation, Pose{}.orientation), 0.0);
}

TEST(Pose, AngleOfAHalfTurn) {
    EXPECT_NEAR(angle_between_rad(Pose{}.orientation, turned(kPi, {0, 1, 0}).orientation), kPi, 1e-14);
}

TEST(Pose, ComposeWithTheInverseIsNoMotion) {
    const Pose pose = turned(2.0, {1, -1, 0.5}, {3, -2, 1});
    const Pose none = compose(pose, inverse(pose));
    EXPECT_LT(glm::length(none.position_m), 1e-14);
    EXPECT_LT(angle_between_rad(none.orientation, Pose{}.orientation), 1e-14);
}

TEST(Pose, ComposeAppliesTheInnerMotionFirst) {
    const Pose outer = turned(kPi / 2, {0, 1, 0}, {0, 1, 0});
    const Pose inner{{0, 0, -2}, {1, 0, 0, 0}};
    EXPECT_LT(glm::length(compose(outer, inner).position_m - glm::dvec3{-2, 1, 0}), 1e-14);
}

}  // namespace
}  // namespace lw
