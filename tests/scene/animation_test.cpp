// Animation against values computed by hand.

#include "scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lw::scene {
namespace {

constexpr double kHalfRoot = 0.70710678118654752440;
// Values are stored as float: 6e-8 relative.
constexpr double kFloat = 1e-7;

AnimationChannel translation(Interpolation interpolation, std::vector<float> times_s, std::vector<glm::vec4> values) {
    AnimationChannel channel;
    channel.property = AnimatedProperty::translation;
    channel.interpolation = interpolation;
    channel.loop_s = static_cast<double>(times_s.back());
    channel.times_s = std::move(times_s);
    channel.values = std::move(values);
    return channel;
}

TEST(Animation, TimeFoldsIntoTheLoop) {
    EXPECT_DOUBLE_EQ(looped_time_s(0.25, 2.0), 0.25);
    EXPECT_DOUBLE_EQ(looped_time_s(2.0, 2.0), 0.0);
    EXPECT_DOUBLE_EQ(looped_time_s(5.5, 2.0), 1.5);
    EXPECT_DOUBLE_EQ(looped_time_s(-0.5, 2.0), 1.5);
    EXPECT_DOUBLE_EQ(looped_time_s(-4.0, 2.0), 0.0);
    EXPECT_LT(looped_time_s(-1e-300, 2.0), 2.0);
}

TEST(Animation, StepHoldsAKeyUntilTheNext) {
    const AnimationChannel channel =
        translation(Interpolation::step, {0.0f, 1.0f, 2.0f}, {{1, 0, 0, 0}, {2, 0, 0, 0}, {3, 0, 0, 0}});
    EXPECT_EQ(channel_value(channel, 0.0).x, 1.0);
    EXPECT_EQ(channel_value(channel, 0.999).x, 1.0);
    EXPECT_EQ(channel_value(channel, 1.0).x, 2.0);
    EXPECT_EQ(channel_value(channel, 2.5).x, 1.0);  // looped to 0.5
}

TEST(Animation, LinearMixesAndHoldsBeforeTheFirstKey) {
    AnimationChannel channel = translation(Interpolation::linear, {1.0f, 3.0f}, {{10, 0, -4, 0}, {20, 8, 4, 0}});
    channel.loop_s = 4.0;
    EXPECT_EQ(channel_value(channel, 0.5), glm::dvec4(10, 0, -4, 0));
    EXPECT_EQ(channel_value(channel, 1.5), glm::dvec4(12.5, 2, -2, 0));
    EXPECT_EQ(channel_value(channel, 3.5), glm::dvec4(20, 8, 4, 0));
}

TEST(Animation, LinearRotationFollowsTheSphereTheShortWay) {
    AnimationChannel channel;
    channel.property = AnimatedProperty::rotation;
    channel.loop_s = 2.0;
    channel.times_s = {0.0f, 2.0f};
    const auto half_root = static_cast<float>(kHalfRoot);
    // No turn, and a quarter turn about Y written with the other sign: the same rotation.
    channel.values = {{0, 0, 0, 1}, {0, -half_root, 0, -half_root}};
    const glm::dvec4 middle = channel_value(channel, 1.0);
    // An eighth of a turn: (0, sin(pi/8), 0, cos(pi/8)) up to sign.
    const double sign = middle.w < 0.0 ? -1.0 : 1.0;
    EXPECT_NEAR(sign * middle.y, std::sin(0.39269908169872414), kFloat);
    EXPECT_NEAR(sign * middle.w, std::cos(0.39269908169872414), kFloat);
    EXPECT_NEAR(glm::length(middle), 1.0, 1e-15);
}

TEST(Animation, CubicIsTheHermiteSplineWithTangentsPerSecond) {
    // Keys at 0 and 2 s with values 1 and 5; out-tangent 3 per second, in-tangent -1 per second.
    const AnimationChannel channel =
        translation(Interpolation::cubic, {0.0f, 2.0f},
                    {{99, 0, 0, 0}, {1, 0, 0, 0}, {3, 0, 0, 0}, {-1, 0, 0, 0}, {5, 0, 0, 0}, {99, 0, 0, 0}});
    EXPECT_EQ(channel_value(channel, 0.0).x, 1.0);
    // t = 1/2: h00 = h01 = 1/2, h10 = 1/8, h11 = -1/8; 0.5 + 2*3/8 + 2.5 + 2*1/8 = 4.
    EXPECT_DOUBLE_EQ(channel_value(channel, 1.0).x, 4.0);
    // t = 1/4: h00 = 27/32, h10 = 9/64, h01 = 5/32, h11 = -3/64; 27/32 + 6*9/64 + 25/32 + 6/64 = 164/64.
    EXPECT_DOUBLE_EQ(channel_value(channel, 0.5).x, 164.0 / 64.0);
}

TEST(Animation, ASingleKeyIsAConstant) {
    AnimationChannel channel = translation(Interpolation::linear, {0.0f}, {{1, 2, 3, 0}});
    channel.loop_s = 1.0;
    EXPECT_EQ(channel_value(channel, 0.7), glm::dvec4(1, 2, 3, 0));
}

}  // namespace
}  // namespace lw::scene
