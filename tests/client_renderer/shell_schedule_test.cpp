// Ranges, priorities and the budget of shells on hand-made cases and a virtual clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "client_renderer/shell_budget.h"
#include "client_renderer/shell_priority.h"
#include "client_renderer/shell_ranges.h"
#include "client_renderer/shell_tiles.h"
#include "client_renderer/tile_savings.h"
#include "core/camera_picture.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(ShellRanges, MeetAndReachFromTheEyeToInfinity) {
    std::vector<double> distances_m;
    for (int i = 1; i <= 100; ++i) distances_m.push_back(i);
    for (const int shells : {0, 2, 3, 4}) {
        ShellRangeSettings settings;
        settings.shells = shells;
        const std::vector<ShellRange> ranges = shell_ranges(settings, distances_m);
        if (shells != 0) {
            EXPECT_EQ(ranges.size(), static_cast<std::size_t>(shells));
        }
        EXPECT_EQ(ranges.front().nearest_m, 0.0);
        EXPECT_TRUE(std::isinf(ranges.back().farthest_m));
        EXPECT_EQ(ranges.back().overlap_m, 0.0);
        for (std::size_t i = 1; i < ranges.size(); ++i) {
            EXPECT_EQ(ranges[i].nearest_m, ranges[i - 1].farthest_m);
            EXPECT_GT(ranges[i - 1].overlap_m, 0.0);
        }
    }
}

TEST(ShellRanges, TheFirstCutIsWhereTheParallaxIsAllowed) {
    std::vector<double> distances_m;
    for (int i = 1; i <= 100; ++i) distances_m.push_back(i);
    ShellRangeSettings settings{2, 256.0, 0.5, 4.0};
    EXPECT_DOUBLE_EQ(shell_ranges(settings, distances_m)[0].farthest_m, 32.0);
    settings.allowed_parallax_px = 128.0;  // 1 m: nothing would be in the nearest shell
    EXPECT_NEAR(shell_ranges(settings, distances_m)[0].farthest_m, 20.0, 1.0);
    settings.allowed_parallax_px = 0.1;  // 1280 m: nothing would be beyond
    EXPECT_NEAR(shell_ranges(settings, distances_m)[0].farthest_m, 90.0, 1.0);
    EXPECT_EQ(shell_ranges(settings, {}).size(), 2U) << "an empty scene is all sky";
}

TEST(ShellRanges, AViewerAtABoundaryDoesNotMakeItSwing) {
    const double infinity = std::numeric_limits<double>::infinity();
    const std::vector<ShellRange> present{{0.0, 8.0, 1.6}, {8.0, infinity, 0.0}};
    EXPECT_FALSE(ranges_outdated(present, std::vector<ShellRange>{{0.0, 15.0, 3.0}, {15.0, infinity, 0.0}}));
    EXPECT_FALSE(ranges_outdated(present, std::vector<ShellRange>{{0.0, 4.5, 0.9}, {4.5, infinity, 0.0}}));
    EXPECT_TRUE(ranges_outdated(present, std::vector<ShellRange>{{0.0, 17.0, 3.4}, {17.0, infinity, 0.0}}));
    EXPECT_TRUE(ranges_outdated(present, std::vector<ShellRange>{{0.0, infinity, 0.0}}));
}

TEST(ShellTiles, EveryDirectionIsOnATileAndTheProbesOfATileAreInIt) {
    const Camera display = test::plain_camera({64, 64});
    const ShellTiles tiles{display, 1.0, 2};
    EXPECT_EQ(tiles.count(), 24);
    for (int i = 0; i < 500; ++i) {
        const double z = 1.0 - 2.0 * (i + 0.5) / 500.0;
        const double around = 2.4 * i;
        const glm::dvec3 direction{std::sqrt(1.0 - z * z) * std::cos(around), z,
                                   std::sqrt(1.0 - z * z) * std::sin(around)};
        int on = 0;
        for (int tile = 0; tile < tiles.count(); ++tile) on += sees(tiles.camera(tile, {}), direction) ? 1 : 0;
        EXPECT_GE(on, 1) << i;
    }
    for (int tile = 0; tile < tiles.count(); ++tile) {
        for (const glm::dvec3& direction : tiles.probes(tile)) {
            EXPECT_TRUE(sees(tiles.camera(tile, {}), direction)) << tile;
        }
    }
    // 32 pixels per tangent, a tangent of one per tile, a rim of two pixels.
    EXPECT_EQ(tiles.camera(0, {}).size_px, glm::ivec2(36, 36));
    EXPECT_NEAR(tiles.camera(0, {}).fov.right - tiles.camera(0, {}).fov.left, 36.0 / 32.0, 1e-12);
    EXPECT_DOUBLE_EQ(tiles.display_pixels(), 1024.0);
}

ItemOutlook seen_item() {
    ItemOutlook item;
    item.drawn = true;
    item.display_px = 10000.0;
    item.visible_share = 1.0;
    item.typical_m = 10.0;
    return item;
}

TEST(ShellPriority, NothingIsWrongWhileNothingMoves) {
    const PredictedError error = predicted_error(seen_item(), {});
    EXPECT_EQ(error.sum(), 0.0);
    EXPECT_STREQ(error.reason(), "");
}

TEST(ShellPriority, WhatWasNeverDrawnIsAllMissing) {
    ItemOutlook item = seen_item();
    item.drawn = false;
    EXPECT_EQ(predicted_error(item, {}).sum(), 10000.0);
    EXPECT_STREQ(predicted_error(item, {}).reason(), "missing");
}

TEST(ShellPriority, EachTermIsPixels) {
    const PriorityWeights weights;
    ItemOutlook item = seen_item();
    item.eye_moved_m = 0.5;
    item.gap_px_per_m = 300.0;
    item.overlap_m = 0.4;
    item.mover_px = 50.0;
    item.age_s = 2.0;
    item.measured_holes_px = 77.0;
    const PredictedError error = predicted_error(item, weights);
    EXPECT_NEAR(error.parallax, 150.0, 1.5) << "a little less: gaps meet";
    EXPECT_DOUBLE_EQ(error.torn, 2500.0) << "a quarter of the overlap too far: a quarter of the pixels";
    EXPECT_DOUBLE_EQ(error.resampled, 10000.0 * weights.resampled * 0.05);
    EXPECT_DOUBLE_EQ(error.movers, 50.0 * weights.movers * 2.0);
    EXPECT_DOUBLE_EQ(error.holes, 77.0);
    EXPECT_STREQ(error.reason(), "torn");
}

TEST(ShellPriority, PartsCanBeSwitchedOff) {
    ItemOutlook item = seen_item();
    item.eye_moved_m = 1.0;
    item.gap_px_per_m = 300.0;
    item.overlap_m = 0.1;
    PriorityWeights weights;
    weights.parallax = 0.0;
    EXPECT_EQ(predicted_error(item, weights).parallax, 0.0);
    EXPECT_EQ(predicted_error(item, weights).torn, 0.0);
    item.off_axis_rad = 1.5;
    EXPECT_LT(error_weight(item, weights), 0.1);
    weights.human_factors = false;
    EXPECT_EQ(error_weight(item, weights), 1.0);
}

TEST(ShellPriority, ThePeripheryCountsLessAsAcuityFalls) {
    const PriorityWeights weights;
    EXPECT_EQ(periphery_falloff(0.0, weights), 1.0);
    EXPECT_EQ(periphery_falloff(weights.b1_rad, weights), 1.0) << "eyes reach so far without the head";
    // Acuity 1 / (1 + e / 2.3 degrees): 0.133 at 15 degrees, 0.0712 at 30.
    EXPECT_NEAR(periphery_falloff(2.0 * weights.b1_rad, weights), 0.0712 / 0.133, 0.01);
}

TEST(ShellPriority, BehindTheHeadCountsLittleAndWhatIsManipulatedMuch) {
    const PriorityWeights weights;
    ItemOutlook ahead = seen_item();
    ItemOutlook behind = seen_item();
    behind.visible_share = 0.0;
    behind.off_axis_rad = 3.0;
    EXPECT_LT(error_weight(behind, weights), 0.01 * error_weight(ahead, weights));
    EXPECT_GT(error_weight(behind, weights), 0.0) << "it must not starve for good";
    ahead.manipulated = true;
    EXPECT_EQ(error_weight(ahead, weights), weights.manipulated);
}

TEST(ShellBudget, TakesTheBestValuePerCostThatFits) {
    const BudgetSettings settings{10.0, 1.0, 4.0};
    // Values per ms: 10, 20, 5, 2.
    const std::vector<DrawCandidate> candidates{
        {0, 80.0, 8.0, 0.1}, {1, 60.0, 3.0, 0.1}, {2, 15.0, 3.0, 0.1}, {3, 8.0, 4.0, 0.1}};
    EXPECT_THAT(choose_items(candidates, settings), ElementsAre(1, 2, 3)) << "item 0 no longer fits beside item 1";
}

TEST(ShellBudget, WhatIsValidIsNotDrawn) {
    EXPECT_THAT(choose_items({{0, 0.9, 1.0, 100.0}, {1, 0.0, 1.0, 100.0}}, {10.0, 1.0, 4.0}), IsEmpty());
}

TEST(ShellBudget, WhoeverWaitedLongestComesFirst) {
    const std::vector<DrawCandidate> candidates{{0, 1000.0, 6.0, 0.1}, {1, 2.0, 6.0, 4.5}, {2, 2.0, 4.0, 5.0}};
    EXPECT_THAT(choose_items(candidates, {10.0, 1.0, 4.0}), ElementsAre(2, 1));
}

TEST(ShellBudget, AnItemDearerThanTheBudgetIsDrawnAloneOnceOverdue) {
    EXPECT_THAT(choose_items({{0, 50.0, 20.0, 1.0}}, {10.0, 1.0, 4.0}), IsEmpty());
    EXPECT_THAT(choose_items({{0, 50.0, 20.0, 4.1}, {1, 50.0, 2.0, 0.0}}, {10.0, 1.0, 4.0}), ElementsAre(0));
}

// Ten items that all become wrong at different speeds, and a budget for two of them per frame.
TEST(ShellBudget, NothingStarvesAndTheBudgetHoldsOnAVirtualClock) {
    const BudgetSettings settings{10.0, 1.0, 2.0};
    std::vector<double> drawn_s(10, 0.0);
    CostBook costs{10};
    double longest_s = 0.0;
    int over_budget = 0;
    for (int frame = 1; frame <= 200; ++frame) {
        const double now_s = 0.1 * frame;
        std::vector<DrawCandidate> candidates;
        for (std::size_t i = 0; i < drawn_s.size(); ++i) {
            const double age_s = now_s - drawn_s[i];
            const double speed = i == 0 ? 1000.0 : 5.0 * static_cast<double>(i);
            candidates.push_back({i, speed * age_s, costs.expected_ms(i, 5.0), age_s});
            longest_s = std::max(longest_s, age_s);
        }
        double spent_ms = 0.0;
        for (const std::size_t i : choose_items(candidates, settings)) {
            const double cost_ms = 4.0 + 0.1 * static_cast<double>(i);
            spent_ms += cost_ms;
            costs.learn(i, cost_ms);
            drawn_s[i] = now_s;
        }
        over_budget += spent_ms > settings.budget_ms ? 1 : 0;
    }
    EXPECT_LT(longest_s, settings.max_age_s + 1.0) << "ten items at two per frame: half a second to serve all";
    EXPECT_LE(over_budget, 10);
}

TEST(CostBook, FollowsWhatIsMeasured) {
    CostBook costs{1};
    EXPECT_EQ(costs.expected_ms(0, 7.0), 7.0);
    costs.learn(0, 10.0);
    EXPECT_EQ(costs.expected_ms(0, 7.0), 10.0);
    costs.learn(0, 20.0);
    EXPECT_GT(costs.expected_ms(0, 7.0), 10.0);
    EXPECT_LT(costs.expected_ms(0, 7.0), 20.0);
    for (int i = 0; i < 20; ++i) costs.learn(0, 20.0);
    EXPECT_NEAR(costs.expected_ms(0, 7.0), 20.0, 0.01);
}

TEST(TileSavings, OfEveryFrameATenthIsSavedUntilATileFits) {
    TileSavings savings;
    BudgetSettings budget{10.0};
    const std::vector<DrawCandidate> tiles{{1, 0.5, 1.0, 0.0}, {2, 5.0, 2.5, 0.0}};  // the first is valid
    for (const double needed_ms : {0.0, 0.0, 2.5, 2.5}) {
        savings.save(10.0);
        EXPECT_EQ(savings.needed_ms(tiles, budget), needed_ms);
    }
    savings.spend(2.5);
    EXPECT_EQ(savings.needed_ms(tiles, budget), 0.0) << "1.5 ms are left";
}

TEST(TileSavings, WhatIsWorthMoreThanADenserViewGetsTwoFifthsAtMost) {
    const TileSavings savings;
    const std::vector<DrawCandidate> tiles{{1, 100.0, 3.0, 0.0}, {2, 80.0, 2.0, 0.0}, {3, 60.0, 1.0, 0.0}};
    EXPECT_EQ(savings.needed_ms(tiles, {10.0}), 4.0) << "the second does not fit beside the first";
    EXPECT_EQ(savings.needed_ms(std::span{tiles}.subspan(1), {10.0}), 3.0);
    EXPECT_EQ(savings.needed_ms({}, {10.0}), 0.0);
}

}  // namespace
}  // namespace lw
