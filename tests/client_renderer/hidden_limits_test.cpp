#include "client_renderer/hidden_limits.h"

#include <gtest/gtest.h>

#include "frame_link/rendered_frame.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

// 90 degrees on 64 pixels: 32 pixels per tangent. Near plane 0.05 m, so a depth is 0.05 / distance.
constexpr int kSidePx = 64;
constexpr float kNear_m = 0.05F;

Camera camera() { return test::plain_camera({kSidePx, kSidePx}); }

/// A wall at 4 m; before it, in columns [20, 44), a board at 1 m.
DepthImage board_before_a_wall() {
    DepthImage depth{{kSidePx, kSidePx}, kNear_m / 4.0F};
    for (int y = 0; y < kSidePx; ++y) {
        for (int x = 20; x < 44; ++x) depth.at(x, y) = kNear_m / 1.0F;
    }
    return depth;
}

TEST(HiddenLimits, AHeadThatDoesNotMoveLooksBehindNothing) {
    const DepthImage limits = hidden_limits(camera(), board_before_a_wall(), 0.0);
    for (const float limit : limits.pixels()) EXPECT_EQ(limit, 0.0F);
}

TEST(HiddenLimits, BehindASilhouetteAsFarAsTheHeadLooks) {
    // 0.2 m sideways: 32 * 0.2 * (1/1 - 1/4) = 4.8 px of the wall come into view on either side.
    const DepthImage limits = hidden_limits(camera(), board_before_a_wall(), 0.2);
    const int y = 30;
    const float board = kNear_m / 1.0F;
    const float wall = kNear_m / 4.0F;
    for (int x = 20; x < 24; ++x) {
        EXPECT_LT(limits.at(x, y), board) << x << ": the board belongs to the first layer";
        EXPECT_GT(limits.at(x, y), wall) << x << ": the wall behind it is wanted";
    }
    for (int x = 27; x < 37; ++x) EXPECT_EQ(limits.at(x, y), 0.0F) << x << ": no one looks that far behind the board";
}

TEST(HiddenLimits, ARimOfTheFartherSurfaceIsWantedToo) {
    const DepthImage limits = hidden_limits(camera(), board_before_a_wall(), 0.2);
    const float wall = kNear_m / 4.0F;
    for (int x = 20 - kRimPx; x < 20; ++x) EXPECT_GT(limits.at(x, 30), wall) << x;
    for (int x = 0; x < 20 - kRimPx; ++x) EXPECT_EQ(limits.at(x, 30), 0.0F) << x;
}

TEST(HiddenLimits, ASlantedFloorHidesNothing) {
    DepthImage depth{{kSidePx, kSidePx}, 0.0F};
    // Eye 1.6 m above a floor: depth is affine in y, and so are the shifts.
    for (int y = 36; y < kSidePx; ++y) {
        const float down = (static_cast<float>(y) + 0.5F - 32.0F) / 32.0F;
        for (int x = 0; x < kSidePx; ++x) depth.at(x, y) = kNear_m * down / 1.6F;
    }
    const DepthImage limits = hidden_limits(camera(), depth, 0.1);
    for (int y = 40; y < kSidePx; ++y) {
        for (int x = 0; x < kSidePx; ++x) EXPECT_EQ(limits.at(x, y), 0.0F) << x << ", " << y;
    }
}

TEST(HiddenLimits, WhatIsNoDepthCountsAsBackground) {
    DepthImage depth = board_before_a_wall();
    for (float& value : depth.pixels()) {
        if (value < 0.02F) value = kNoSurfaceDepth;
    }
    const DepthImage limits = hidden_limits(camera(), depth, 0.2);
    EXPECT_GT(limits.at(21, 30), 0.0F);
    EXPECT_LT(limits.at(21, 30), kNear_m);
}

}  // namespace
}  // namespace lw
