#include "apps/user_head.h"

#include <gtest/gtest.h>

namespace lw {
namespace {

const Pose kAhead{glm::dvec3{1.0, 1.6, 2.0}, glm::dquat{1.0, 0.0, 0.0, 0.0}};

glm::dvec3 forward_of(const Pose& pose) { return pose.orientation * glm::dvec3{0.0, 0.0, -1.0}; }

TEST(UserHead, FollowsTheTraceUntilTouched) {
    UserHead head;
    head.advance({}, from_ms(2.0), kAhead);
    EXPECT_EQ(head.pose(), kAhead);
    EXPECT_FALSE(head.is_taken());
}

TEST(UserHead, StaysWhereItIsOnceTaken) {
    UserHead head;
    HeadInput input;
    input.move = {0.0, 0.0, -1.0};
    head.advance(input, Duration{0}, kAhead);
    Pose elsewhere = kAhead;
    elsewhere.position_m.x = 50.0;
    head.advance({}, from_ms(2.0), elsewhere);
    EXPECT_TRUE(head.is_taken());
    EXPECT_EQ(head.pose().position_m, kAhead.position_m);
}

TEST(UserHead, TakingOverKeepsTheDirectionOfView) {
    UserHead head;
    Pose turned = kAhead;
    turned.orientation =
        glm::angleAxis(1.2, glm::dvec3{0.0, 1.0, 0.0}) * glm::angleAxis(-0.3, glm::dvec3{1.0, 0.0, 0.0});
    HeadInput input;
    input.move = {1.0, 0.0, 0.0};
    head.advance(input, Duration{0}, turned);
    EXPECT_NEAR(glm::distance(forward_of(head.pose()), forward_of(turned)), 0.0, 1e-12);
}

TEST(UserHead, WalksForwardAtItsSpeed) {
    UserHead head;
    HeadInput input;
    input.move = {0.0, 0.0, -1.0};
    for (int i = 0; i < 500; ++i) head.advance(input, from_ms(2.0), kAhead);
    EXPECT_NEAR(head.pose().position_m.z, kAhead.position_m.z - 1.5, 1e-9);  // one second at 1.5 m/s
}

TEST(UserHead, TurnsRightWithTheMouseAndNeverOverTheTop) {
    UserHead head;
    HeadInput input;
    input.turn_px = {100.0, 0.0};
    head.advance(input, from_ms(2.0), kAhead);
    EXPECT_GT(forward_of(head.pose()).x, 0.1);
    input.turn_px = {0.0, -1e6};
    head.advance(input, from_ms(2.0), kAhead);
    EXPECT_LT((head.pose().orientation * glm::dvec3{0.0, 1.0, 0.0}).y, 0.1);
    EXPECT_GT((head.pose().orientation * glm::dvec3{0.0, 1.0, 0.0}).y, 0.0);  // not upside down
}

}  // namespace
}  // namespace lw
