#include "client_renderer/view_plan.h"

#include <gtest/gtest.h>

namespace lw {
namespace {

TEST(ViewCosts, BeforeAViewWasDrawnItIsOneOfEverything) {
    ViewCosts costs;
    costs.start(1e5, 0.5);
    const ViewPlan plain{1.0, false};
    EXPECT_DOUBLE_EQ(costs.expected_ms(plain, {1e5}), ViewCosts::modelled_ms({1e5, 1e5, 0.5e5, {}, 0.0}));
}

TEST(ViewCosts, WhatWasDrawnSaysWhatOtherSizesCost) {
    ViewCosts costs;
    costs.start(1e6, 1.0);
    const ViewCosts::Drawn view{2e5, 3e4, 1e5, {}, 0.0};
    costs.learn(view, ViewCosts::modelled_ms(view));
    EXPECT_NEAR(costs.expected_ms({1.0, false}, {2e5}), ViewCosts::modelled_ms(view), 1e-12);
    EXPECT_NEAR(costs.expected_ms({2.0, false}, {8e5}), ViewCosts::modelled_ms({8e5, 3e4, 4e5, {}, 0.0}), 1e-12);
}

TEST(ViewCosts, OneSideHasItsShareOfTheTriangles) {
    ViewCosts costs;
    costs.start(1e6, 1.0);
    const ViewCosts::Drawn side{1e5, 3e4, 4e4, {}, 0.0, 0.5};
    costs.learn(side, ViewCosts::modelled_ms(side));
    const double whole_ms = costs.expected_ms({1.0, false}, {2e5, 1.0, 0.8});
    EXPECT_NEAR(whole_ms, ViewCosts::modelled_ms({2e5, 6e4, 1.6e5, {}, 0.0}), 1e-12);
}

TEST(ViewCosts, AMachineThatIsTwiceAsSlowIsLearned) {
    ViewCosts costs;
    costs.start(1e5, 0.5);
    const ViewCosts::Drawn view{2e5, 3e4, 1e5, 2e4, 1e4};
    costs.learn(view, 2.0 * ViewCosts::modelled_ms(view));
    EXPECT_NEAR(costs.expected_ms({1.0, true}, {2e5}), 2.0 * ViewCosts::modelled_ms(view), 1e-9);
    for (int i = 0; i < 60; ++i) costs.learn(view, ViewCosts::modelled_ms(view));
    EXPECT_NEAR(costs.expected_ms({1.0, true}, {2e5}), ViewCosts::modelled_ms(view), 1e-9);
}

TEST(ViewPlans, DensityIsGivenUpBeforeWhatTheEyeIsExpectedToSee) {
    ASSERT_FALSE(view_plans().empty());
    EXPECT_EQ(view_plans().front().density, 2.0);
    EXPECT_TRUE(view_plans().front().hidden);
    EXPECT_EQ(view_plans().back().extent_share, 0.0);
    EXPECT_FALSE(view_plans().back().hidden);
    for (const ViewPlan& plan : view_plans()) {
        EXPECT_GE(plan.density, 1.0);
        if (plan.extent_share < 1.0) {
            EXPECT_EQ(plan.density, 1.0);
        }
    }
}

}  // namespace
}  // namespace lw
