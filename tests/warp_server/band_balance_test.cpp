#include "warp_server/methods/band_balance.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

namespace lw::test {
namespace {

// Of 1000 rows, each estimated to cost the same.
std::vector<float> even_costs() {
    std::vector<float> cost_until(1001);
    std::iota(cost_until.begin(), cost_until.end(), 0.0F);
    return cost_until;
}

// What bands take when rows before `border` really cost `factor` times the others.
std::vector<double> times_of(std::span<const RowRange> bands, int border, double factor) {
    std::vector<double> times;
    for (const RowRange& band : bands) {
        const int dear = std::max(0, std::min(band.end, border) - band.begin);
        times.push_back(factor * dear + (band.end - band.begin - dear));
    }
    return times;
}

TEST(BandBalance, BeginsWithTheEstimate) {
    BandBalance balance;
    std::array<RowRange, 4> bands;
    balance.cut(even_costs(), bands);
    EXPECT_EQ(bands[0].begin, 0);
    EXPECT_EQ(bands[1].begin, 250);
    EXPECT_EQ(bands[3].begin, 750);
    EXPECT_EQ(bands[3].end, 1000);
}

TEST(BandBalance, LearnsWhereTheEstimateIsWrong) {
    for (const std::size_t count : {2U, 3U}) {
        BandBalance balance;
        std::vector<RowRange> bands(count);
        std::vector<double> times;
        for (int picture = 0; picture < 60; ++picture) {
            balance.cut(even_costs(), bands);
            times = times_of(bands, 300, 3.0);
            balance.learn(times);
        }
        for (const double time : times) EXPECT_NEAR(time, 1600.0 / static_cast<double>(count), 16.0);  // 1 %
    }
}

TEST(BandBalance, OneDisturbedPictureMovesABorderByLittle) {
    BandBalance balance;
    std::array<RowRange, 2> bands;
    balance.cut(even_costs(), bands);
    balance.learn(std::array{500.0, 50000.0});
    balance.cut(even_costs(), bands);
    EXPECT_EQ(bands[1].begin, 530);
}

TEST(BandBalance, LearnsNothingFromNoTimeOrOtherBands) {
    BandBalance balance;
    std::array<RowRange, 2> bands;
    balance.cut(even_costs(), bands);
    balance.learn(std::array{0.0, 0.0});
    balance.learn(std::array{1.0, 2.0, 3.0});
    balance.cut(even_costs(), bands);
    EXPECT_EQ(bands[1].begin, 500);
}

TEST(BandBalance, BandsCoverAPictureOfNoCost) {
    BandBalance balance;
    std::array<RowRange, 3> bands;
    balance.cut(std::vector<float>(11, 0.0F), bands);
    EXPECT_EQ(bands.front().begin, 0);
    EXPECT_EQ(bands.back().end, 10);
    for (std::size_t i = 1; i < bands.size(); ++i) EXPECT_EQ(bands[i].begin, bands[i - 1].end);
}

}  // namespace
}  // namespace lw::test
