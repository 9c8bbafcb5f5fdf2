#include "frame_link/trace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lw {
namespace {

constexpr double kPi = 3.14159265358979323846;

glm::dquat turned(double yaw_deg, double pitch_deg = 0.0, double roll_deg = 0.0) {
    return glm::angleAxis(glm::radians(yaw_deg), glm::dvec3{0.0, 1.0, 0.0}) *
           glm::angleAxis(glm::radians(pitch_deg), glm::dvec3{1.0, 0.0, 0.0}) *
           glm::angleAxis(glm::radians(roll_deg), glm::dvec3{0.0, 0.0, 1.0});
}

Trace three_poses() {
    return Trace{"three",
                 {{10.0, {{1.0, 1.5, 2.0}, turned(90.0)}},
                  {10.5, {{2.0, 1.5, 2.0}, turned(120.0, 10.0)}},
                  {12.0, {{2.0, 1.8, 3.0}, turned(150.0, -20.0, 5.0)}}}};
}

// Rounding of a few quaternion products and one sine.
constexpr double kRounding = 1e-12;

void expect_pose_near(const Pose& actual, const Pose& expected, double tolerance = kRounding) {
    EXPECT_LE(glm::length(actual.position_m - expected.position_m), tolerance);
    EXPECT_LE(angle_between_rad(actual.orientation, expected.orientation), tolerance);
}

TEST(Trace, GivesItsSamplesBackExactlyAndHoldsOutside) {
    const Trace trace = three_poses();
    EXPECT_EQ(trace.duration_s(), 2.0);
    EXPECT_EQ(trace.at(0.0), trace.poses()[0].world_from_head);
    EXPECT_EQ(trace.at(0.5), trace.poses()[1].world_from_head);
    EXPECT_EQ(trace.at(2.0), trace.poses()[2].world_from_head);
    EXPECT_EQ(trace.at(-5.0), trace.poses()[0].world_from_head);
    EXPECT_EQ(trace.at(99.0), trace.poses()[2].world_from_head);
}

TEST(Trace, InterpolatesOnTheSphere) {
    const Trace trace{"turn", {{0.0, {{}, turned(0.0)}}, {1.0, {{4.0, 0.0, 0.0}, turned(160.0)}}}};
    expect_pose_near(trace.at(0.25), {{1.0, 0.0, 0.0}, turned(40.0)});
}

TEST(Trace, TakesTheShorterWayBetweenOppositeSigns) {
    const Trace trace{"sign", {{0.0, {{}, turned(10.0)}}, {1.0, {{}, -turned(20.0)}}}};
    expect_pose_near(trace.at(0.5), {{}, turned(15.0)});
}

TEST(TraceDeathTest, RefusesWhatNoImporterMayHandOver) {
    const Pose pose;
    EXPECT_DEATH((Trace{"empty", {}}), "at least one pose");
    EXPECT_DEATH((Trace{"back", {{1.0, pose}, {1.0, pose}}}), "pose 1");
    EXPECT_DEATH((Trace{"long", {{0.0, {{}, {2.0, 0.0, 0.0, 0.0}}}}}), "not a rigid one");
}

TEST(Heading, IsTheYawOfTheView) {
    for (double yaw_deg = -175.0; yaw_deg < 180.0; yaw_deg += 25.0) {
        for (const double pitch_deg : {-90.0, -85.0, -60.0, 0.0, 45.0, 79.0, 88.0, 90.0}) {
            EXPECT_NEAR(glm::degrees(heading_rad(turned(yaw_deg, pitch_deg))), yaw_deg, 1e-9) << pitch_deg;
        }
        EXPECT_NEAR(glm::degrees(heading_rad(turned(yaw_deg, 20.0, 30.0))), yaw_deg, 1e-9) << "roll turns no view";
    }
    EXPECT_NEAR(std::abs(heading_rad(turned(180.0))), kPi, 1e-12);
}

TEST(TracePlacement, BeginsAtTheStartPoseInPositionAndHeading) {
    const Pose start{{-3.0, 2.0, 7.0}, turned(-40.0, -30.0)};
    const Trace placed = three_poses().placed_at(start, 0.0);
    EXPECT_EQ(placed.poses().front().time_s, 0.0);
    EXPECT_EQ(placed.duration_s(), 2.0);
    expect_pose_near(placed.at(0.0), {start.position_m, turned(-40.0)});
}

TEST(TracePlacement, TurnsMotionWithTheHeadingAndKeepsPitchAndRoll) {
    // From heading 90 (looking along -X) to 0 (along -Z): a turn by -90 degrees, so +X becomes +Z.
    const Trace placed = three_poses().placed_at({{0.0, 0.0, 0.0}, turned(0.0)}, 0.0);
    expect_pose_near(placed.at(0.5), {{0.0, 0.0, 1.0}, turned(30.0, 10.0)});
    expect_pose_near(placed.at(2.0), {{-1.0, 0.3, 1.0}, turned(60.0, -20.0, 5.0)});
}

TEST(TracePlacement, SkipsIntoTheTraceAndHoldsAfterItsEnd) {
    const Trace trace = three_poses();
    const Pose start{{5.0, 1.0, 5.0}, turned(10.0)};
    const Trace placed = trace.placed_at(start, 0.25);
    EXPECT_NEAR(placed.duration_s(), 1.75, 1e-12);
    EXPECT_EQ(placed.at(0.0).position_m, start.position_m);
    EXPECT_NEAR(glm::degrees(heading_rad(placed.at(0.0).orientation)), 10.0, 1e-9);

    const Trace past = trace.placed_at(start, 50.0);
    EXPECT_EQ(past.poses().size(), 1U);
    EXPECT_EQ(past.at(3.0).position_m, start.position_m);
}

TEST(TracePlacement, AHeadThatLooksStraightDownHasAHeading) {
    const Trace trace{"floor", {{0.0, {{}, turned(70.0, -90.0)}}, {1.0, {{0.0, 0.0, -1.0}, turned(70.0, 0.0)}}}};
    const Trace placed = trace.placed_at({{}, turned(0.0)}, 0.0);
    expect_pose_near(placed.at(0.0), {{}, turned(0.0, -90.0)});
    EXPECT_NEAR(heading_rad(placed.at(1.0).orientation), 0.0, 1e-12);
}

TEST(BuiltInTraces, AreLongSmoothAndTheSameEveryTime) {
    for (const std::string_view name : built_in_trace_names()) {
        const auto trace = load_trace(std::string{name});
        ASSERT_TRUE(trace.ok()) << name;
        EXPECT_EQ(trace->name(), name);
        EXPECT_GE(trace->duration_s(), 60.0 - 1e-9) << name;
        EXPECT_TRUE(trace->warnings().empty()) << name;
        EXPECT_LE(glm::length(trace->at(0.0).position_m - glm::dvec3(0.0, 1.6, 0.0)), 1e-12) << name;
        EXPECT_LE(angle_between_rad(trace->at(0.0).orientation, glm::dquat(1.0, 0.0, 0.0, 0.0)), 1e-12) << name;

        const auto again = load_trace(std::string{name});
        EXPECT_TRUE(std::equal(trace->poses().begin(), trace->poses().end(), again->poses().begin(),
                               [](const TimedPose& a, const TimedPose& b) {
                                   return a.time_s == b.time_s && a.world_from_head == b.world_from_head;
                               }))
            << name;
    }
}

/// Largest turn and move rates and their changes from one 1/240 s to the next.
struct Smoothness {
    double turn_deg_per_s = 0.0;
    double turn_change_deg_per_s2 = 0.0;
    double move_m_per_s = 0.0;
    double move_change_m_per_s2 = 0.0;
};

Smoothness smoothness_of(const Trace& trace) {
    Smoothness most;
    glm::dvec3 last_turn{0.0};
    glm::dvec3 last_move{0.0};
    for (std::size_t i = 1; i < trace.poses().size(); ++i) {
        const TimedPose& a = trace.poses()[i - 1];
        const TimedPose& b = trace.poses()[i];
        const double step_s = b.time_s - a.time_s;
        const glm::dvec3 turn =
            rotation_vector(b.world_from_head.orientation * glm::conjugate(a.world_from_head.orientation)) / step_s;
        const glm::dvec3 move = (b.world_from_head.position_m - a.world_from_head.position_m) / step_s;
        most.turn_deg_per_s = std::max(most.turn_deg_per_s, glm::degrees(glm::length(turn)));
        most.move_m_per_s = std::max(most.move_m_per_s, glm::length(move));
        most.turn_change_deg_per_s2 =
            std::max(most.turn_change_deg_per_s2, glm::degrees(glm::length(turn - last_turn)) / step_s);
        most.move_change_m_per_s2 = std::max(most.move_change_m_per_s2, glm::length(move - last_move) / step_s);
        last_turn = turn;
        last_move = move;
    }
    return most;
}

// People turn their heads by up to 650 deg/s and 8000 deg/s^2 (the fastest of the recordings); the scripts stay below.
TEST(BuiltInTraces, MoveAsPeopleDo) {
    const Smoothness look = smoothness_of(*load_trace("look-around"));
    EXPECT_GT(look.turn_deg_per_s, 100.0);
    EXPECT_LT(look.turn_deg_per_s, 200.0);
    EXPECT_LT(look.turn_change_deg_per_s2, 2000.0);
    EXPECT_LT(look.move_m_per_s, 0.5);

    const Smoothness walk = smoothness_of(*load_trace("walk"));
    EXPECT_GT(walk.move_m_per_s, 1.1);
    EXPECT_LT(walk.move_m_per_s, 1.7);
    EXPECT_LT(walk.move_change_m_per_s2, 8.0);
    EXPECT_LT(walk.turn_deg_per_s, 150.0);

    const Smoothness shake = smoothness_of(*load_trace("shake"));
    EXPECT_GT(shake.turn_deg_per_s, 250.0);
    EXPECT_LT(shake.turn_deg_per_s, 350.0);
    EXPECT_LT(shake.turn_change_deg_per_s2, 6000.0);

    EXPECT_EQ(smoothness_of(*load_trace("still")).turn_deg_per_s, 0.0);
}

TEST(BuiltInTraces, DiveSeesItsMiddleFromAboveThenTurnsOnceInIt) {
    const Trace dive = *load_trace("dive");
    EXPECT_NEAR(dive.at(20.0).position_m.y, 14.6, 0.05);
    EXPECT_LT(glm::length(dive.at(30.0).position_m - glm::dvec3(3.0, 1.6, -50.0)), 1.0);
    for (const double time_s : {30.5, 32.0, 34.0, 38.0, 41.0}) {
        EXPECT_LT(glm::length(dive.at(time_s).position_m - glm::dvec3(0.5, 1.6, -50.0)), 3.5) << time_s;
    }
    EXPECT_NEAR(heading_rad(dive.at(35.5).orientation), std::acos(-1.0), 0.01) << "half a turn";
    EXPECT_LT(glm::length(dive.at(60.0).position_m - glm::dvec3(3.0, 14.6, 27.0)), 0.1);
    EXPECT_LT(smoothness_of(dive).turn_change_deg_per_s2, 100.0);
}

TEST(BuiltInTraces, WalkStartsForwardAndComesBack) {
    const Trace walk = *load_trace("walk");
    EXPECT_LT(walk.at(5.0).position_m.z, -4.0) << "forward is -Z";
    EXPECT_LT(walk.at(15.0).position_m.z, -12.0);
    // After two loops the walker is back but for bounce and look: some centimetres.
    EXPECT_LT(glm::length(walk.at(60.0).position_m - walk.at(0.0).position_m), 0.2);
}

TEST(TraceFeed, StampsSamplesAtTheTrackerRate) {
    const TraceFeed feed{three_poses(), at_seconds(100.0), 1000.0};
    std::array<PoseSample, 3> samples;
    EXPECT_EQ(feed.newest(at_seconds(99.9999), samples), 0U);
    EXPECT_EQ(feed.newest(at_seconds(100.0), samples), 1U);
    EXPECT_EQ(samples[0].number, 1U);

    ASSERT_EQ(feed.newest(at_seconds(100.4999), samples), 3U);
    EXPECT_EQ(samples[0].time, at_seconds(100.499));
    EXPECT_EQ(samples[1].time, at_seconds(100.498));
    EXPECT_EQ(samples[0].number, 500U);
    EXPECT_EQ(samples[2].number, 498U);
    expect_pose_near(samples[0].world_from_head, three_poses().at(0.499));
    expect_pose_near(feed.pose_at(at_seconds(101.0)), three_poses().at(1.0));
}

TEST(TraceFeed, FindsASampleAtItsOwnStampAtOddRates) {
    for (const double rate_hz : {1000.0, 72.0, 90.0, 333.3, 7919.0}) {
        const TraceFeed feed{three_poses(), at_seconds(3.0), rate_hz};
        std::array<PoseSample, 1> sample;
        for (std::uint64_t number = 1; number < 3000; number += 7) {
            const TimePoint stamp = at_seconds(3.0) + from_seconds(static_cast<double>(number - 1) / rate_hz);
            ASSERT_EQ(feed.newest(stamp, sample), 1U);
            ASSERT_EQ(sample[0].number, number) << rate_hz;
            ASSERT_EQ(sample[0].time, stamp) << rate_hz;
            if (number == 1) continue;
            ASSERT_EQ(feed.newest(stamp - Duration{1}, sample), 1U);
            ASSERT_EQ(sample[0].number, number - 1) << rate_hz;
        }
    }
}

TEST(TraceFeed, GoesOnAfterTheEnd) {
    const TraceFeed feed{three_poses(), TimePoint{}, 100.0};
    std::array<PoseSample, 2> samples;
    ASSERT_EQ(feed.newest(at_seconds(500.0), samples), 2U);
    EXPECT_EQ(samples[0].time, at_seconds(500.0));
    EXPECT_EQ(samples[0].world_from_head, three_poses().poses().back().world_from_head);
}

}  // namespace
}  // namespace lw
