#include "core/statistics.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace lw {
namespace {

TEST(Statistics, NothingWithoutSamples) { EXPECT_FALSE(distribution_of({})); }

TEST(Statistics, OneSampleIsEverything) {
    const std::vector<double> samples{3.5};
    EXPECT_EQ(distribution_of(samples), (Distribution{3.5, 3.5, 3.5, 3.5, 3.5, 3.5, 3.5}));
}

TEST(Statistics, NearestRankOfOneToHundredInAnyOrder) {
    std::vector<double> samples;
    for (int i = 0; i < 100; ++i) samples.push_back((i * 37) % 100 + 1);  // a permutation of 1..100
    EXPECT_EQ(distribution_of(samples), (Distribution{50.5, 1, 5, 50, 95, 99, 100}));
}

TEST(Statistics, RanksAreNotRoundedUpByTheLastBit) {
    std::vector<double> samples;
    for (int i = 1; i <= 20; ++i) samples.push_back(i);
    EXPECT_EQ(percentile_of_sorted(samples, 95.0), 19.0);  // 0.95 * 20 is 19 exactly, but not in binary
    EXPECT_EQ(percentile_of_sorted(samples, 99.0), 20.0);
    EXPECT_EQ(percentile_of_sorted(samples, 5.0), 1.0);
    EXPECT_EQ(percentile_of_sorted(samples, 100.0), 20.0);
}

TEST(Statistics, MeanOfEqualSamplesIsThatSample) {
    const std::vector<double> samples(3, 0.1);
    EXPECT_EQ(distribution_of(samples)->mean, 0.1);
}

TEST(StatisticsDeathTest, RefusesWhatIsNotFinite) {
    const std::vector<double> samples{1.0, std::numeric_limits<double>::infinity()};
    EXPECT_DEATH((void)distribution_of(samples), "check failed");
}

}  // namespace
}  // namespace lw
