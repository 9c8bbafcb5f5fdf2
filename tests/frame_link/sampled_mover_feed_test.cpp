#include "frame_link/sampled_mover_feed.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

namespace lw {
namespace {

// A mover on a circle of 2 m about its own path, turning at 1 rad/s and driving at 3 m/s, scaled and mirrored.
glm::dmat4 driving(double time_s) {
    glm::dmat4 placement = glm::translate(glm::dmat4{1.0}, glm::dvec3{3.0 * time_s, 0.5, -1.0});
    placement = glm::rotate(placement, time_s, glm::normalize(glm::dvec3{0.1, 1.0, 0.0}));
    return glm::scale(placement, glm::dvec3{2.0, -1.0, 0.5});
}

double largest_difference(const glm::dmat4& a, const glm::dmat4& b) {
    double most = 0.0;
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) most = std::max(most, std::abs(a[column][row] - b[column][row]));
    }
    return most;
}

TEST(SampledMoverFeed, SteadyMotionIsCarriedOnExactly) {
    SampledMoverFeed feed;
    std::vector<ObjectTransform> placements;
    feed.placements_at(at_seconds(1.0), placements);
    EXPECT_TRUE(placements.empty());
    for (int i = 0; i <= 10; ++i) {
        const std::array<ObjectTransform, 2> update{{{2, driving(0.05 * i)}, {7, glm::dmat4{1.0}}}};
        EXPECT_TRUE(feed.push(at_seconds(0.05 * i), update));
    }
    // Between the updates, and up to 30 ms after the newest.
    for (const double time_s : {0.46, 0.48, 0.5, 0.51, 0.53}) {
        feed.placements_at(at_seconds(time_s), placements);
        ASSERT_EQ(placements.size(), 2u);
        EXPECT_LT(largest_difference(placements[0].world_from_object, driving(time_s)), 1e-9) << time_s;
        EXPECT_LT(largest_difference(placements[1].world_from_object, glm::dmat4{1.0}), 1e-15);
    }
    // Then it slows down and stands still: 30 ms and 80 ms more.
    feed.placements_at(at_seconds(9.0), placements);
    EXPECT_LT(largest_difference(placements[0].world_from_object, driving(0.61)), 1e-6);
}

TEST(SampledMoverFeed, ANewMoverStandsStillAndALostOneIsGone) {
    SampledMoverFeed feed;
    feed.push(at_seconds(0.0), std::array<ObjectTransform, 2>{{{1, driving(0.0)}, {3, driving(0.0)}}});
    feed.push(at_seconds(0.1), std::array<ObjectTransform, 2>{{{2, driving(0.1)}, {3, driving(0.1)}}});
    std::vector<ObjectTransform> placements;
    feed.placements_at(at_seconds(0.12), placements);
    ASSERT_EQ(placements.size(), 2u);
    EXPECT_EQ(placements[0].id, 2);
    EXPECT_EQ(placements[0].world_from_object, driving(0.1));
    EXPECT_LT(largest_difference(placements[1].world_from_object, driving(0.12)), 1e-9);
}

TEST(SampledMoverFeed, PassesOverWhatCannotBe) {
    SampledMoverFeed feed;
    glm::dmat4 bad{1.0};
    bad[3][1] = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(feed.push(at_seconds(1.0), std::array<ObjectTransform, 2>{{{1, driving(1.0)}, {2, bad}}}));
    EXPECT_FALSE(feed.push(at_seconds(1.0), std::array<ObjectTransform, 1>{{{1, driving(2.0)}}}));
    EXPECT_FALSE(feed.push(at_seconds(0.5), std::array<ObjectTransform, 1>{{{1, driving(2.0)}}}));
    std::vector<ObjectTransform> placements;
    feed.placements_at(at_seconds(3.0), placements);
    ASSERT_EQ(placements.size(), 1u);
    EXPECT_EQ(placements[0].world_from_object, driving(1.0));
    // After a pause of more than a second the old velocity says nothing.
    feed.push(at_seconds(5.0), std::array<ObjectTransform, 1>{{{1, driving(5.0)}}});
    feed.placements_at(at_seconds(5.02), placements);
    EXPECT_EQ(placements[0].world_from_object, driving(5.0));
}

TEST(SampledMoverFeed, AFlatObjectMovesWithoutTurning) {
    const glm::dmat4 flat = glm::scale(glm::dmat4{1.0}, glm::dvec3{1.0, 0.0, 1.0});
    const glm::dmat4 moved = glm::translate(glm::dmat4{1.0}, glm::dvec3{1.0, 0.0, 0.0}) * flat;
    EXPECT_EQ(carried_on(flat, moved, 1.0, 1.0)[3].x, 2.0);
}

}  // namespace
}  // namespace lw
