#include "frame_link/sampled_head_feed.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

namespace lw {
namespace {

TimePoint at_ms(std::int64_t ms) { return TimePoint{std::chrono::milliseconds{ms}}; }

/// A pose that tells its number in every component.
Pose marked(std::uint64_t number) {
    const auto mark = static_cast<double>(number);
    const double half = 1e-3 * mark;
    return {{mark, 2.0 * mark, -mark}, {std::cos(half), 0.0, std::sin(half), 0.0}};
}

TEST(SampledHeadFeed, IsEmptyAtFirst) {
    const SampledHeadFeed feed;
    std::array<PoseSample, 4> samples;
    EXPECT_EQ(feed.newest(at_ms(1000), samples), 0U);
}

TEST(SampledHeadFeed, GivesTheNewestFirstAndNoneFromTheFuture) {
    SampledHeadFeed feed;
    for (std::uint64_t n = 1; n <= 10; ++n) EXPECT_TRUE(feed.push(at_ms(static_cast<std::int64_t>(n)), marked(n)));
    std::array<PoseSample, 4> samples;
    ASSERT_EQ(feed.newest(at_ms(6), samples), 4U);
    for (std::uint64_t i = 0; i < 4; ++i) {
        EXPECT_EQ(samples[i].number, 6 - i);
        EXPECT_EQ(samples[i].time, at_ms(static_cast<std::int64_t>(6 - i)));
        EXPECT_EQ(samples[i].world_from_head.position_m.x, static_cast<double>(6 - i));
    }
    EXPECT_EQ(feed.newest(at_ms(2), samples), 2U);
    EXPECT_EQ(feed.newest(at_ms(0), samples), 0U);
}

TEST(SampledHeadFeed, RefusesUnusablePosesAndOldTimes) {
    SampledHeadFeed feed;
    EXPECT_TRUE(feed.push(at_ms(5), marked(1)));
    EXPECT_FALSE(feed.push(at_ms(5), marked(2)));
    EXPECT_FALSE(feed.push(at_ms(4), marked(2)));
    EXPECT_FALSE(feed.push(at_ms(6), Pose{{std::nan(""), 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}));
    EXPECT_FALSE(feed.push(at_ms(6), Pose{{}, {0.0, 0.0, 0.0, 0.0}}));
    EXPECT_TRUE(feed.push(at_ms(6), Pose{{}, {2.0, 0.0, 0.0, 0.0}}));
    std::array<PoseSample, 4> samples;
    ASSERT_EQ(feed.newest(at_ms(9), samples), 2U);
    EXPECT_EQ(samples[0].number, 2U);
    EXPECT_EQ(samples[0].world_from_head.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0)) << "normalised";
}

TEST(SampledHeadFeed, KeepsOneRingOfSamples) {
    SampledHeadFeed feed;
    constexpr std::uint64_t kPushed = 3 * SampledHeadFeed::kCapacity + 17;
    for (std::uint64_t n = 1; n <= kPushed; ++n) ASSERT_TRUE(feed.push(at_ms(static_cast<std::int64_t>(n)), marked(n)));
    std::vector<PoseSample> samples(2 * SampledHeadFeed::kCapacity);
    ASSERT_EQ(feed.newest(at_ms(1 << 20), samples), SampledHeadFeed::kCapacity);
    for (std::size_t i = 0; i < SampledHeadFeed::kCapacity; ++i) ASSERT_EQ(samples[i].number, kPushed - i);
}

// The writer laps the ring hundreds of times while readers read it whole: every sample must be of one piece.
TEST(SampledHeadFeed, ReadersNeverSeeHalfASample) {
    SampledHeadFeed feed;
    constexpr std::uint64_t kPushed = 100'000;
    std::atomic<std::uint64_t> broken{0};
    const auto read = [&] {
        std::vector<PoseSample> samples(SampledHeadFeed::kCapacity);
        for (std::uint64_t seen = 0; seen < kPushed;) {
            const std::size_t count = feed.newest(TimePoint::max(), samples);
            for (std::size_t i = 0; i < count; ++i) {
                const PoseSample& sample = samples[i];
                const bool whole = sample.world_from_head.position_m == marked(sample.number).position_m &&
                                   sample.time == at_ms(static_cast<std::int64_t>(sample.number)) &&
                                   (i == 0 || sample.number + 1 == samples[i - 1].number);
                if (!whole) broken.fetch_add(1);
            }
            if (count > 0) seen = samples[0].number;
        }
    };
    std::thread first{read};
    std::thread second{read};
    for (std::uint64_t n = 1; n <= kPushed; ++n) feed.push(at_ms(static_cast<std::int64_t>(n)), marked(n));
    first.join();
    second.join();
    EXPECT_EQ(broken.load(), 0U);
}

}  // namespace
}  // namespace lw
