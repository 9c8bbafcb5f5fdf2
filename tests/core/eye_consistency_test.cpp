#include "core/eye_consistency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/core/card_scene.h"

namespace lw::test {
namespace {

constexpr int kSide_px = 64;

// What each eye sees of a card before a wall: the wall moves by 2 px between the eyes, the card by 10.
class EyeConsistencyTest : public testing::Test {
protected:
    using Brightness = std::function<double(double x_wall_px, double y_px)>;

    // A picture painted on the wall, in pixels of the left eye; the card is plain.
    [[nodiscard]] static ColourImage painted(const CardPicture& view, double shift_px, const Brightness& brightness) {
        ColourImage picture{{kSide_px, kSide_px}};
        for (int y = 0; y < kSide_px; ++y) {
            for (int x = 0; x < kSide_px; ++x) {
                const double value = view.is_card(x, y) ? 0.5 : brightness(x + 0.5 + shift_px, y + 0.5);
                const auto level = static_cast<std::uint8_t>(std::lround(255.0 * value));
                picture.at(x, y) = {level, level, level, 255};
            }
        }
        return picture;
    }
    [[nodiscard]] static double waves(double x, double y) {
        return 0.5 + 0.2 * std::sin(0.35 * x) + 0.2 * std::sin(0.45 * y + 0.2 * x);
    }

    [[nodiscard]] std::optional<EyeConsistency> judged(const ColourImage& left_shown, const ColourImage& right_shown) {
        const SampledView left_view = left_.view();
        const SampledView right_view = right_.view();
        return eye_consistency({left_view, left_truth_, left_shown, left_invented_},
                               {right_view, right_truth_, right_shown, right_invented_}, 1);
    }

    CardPicture left_ = draw_cards({}, card_camera(0.0, kSide_px));
    CardPicture right_ = draw_cards({}, card_camera(0.625, kSide_px));
    ColourImage left_truth_ = painted(left_, 0.0, waves);
    ColourImage right_truth_ = painted(right_, 2.0, waves);
    Image<std::uint8_t> left_invented_{{kSide_px, kSide_px}};
    Image<std::uint8_t> right_invented_{{kSide_px, kSide_px}};
};

TEST_F(EyeConsistencyTest, TheTruthAgreesWithItself) {
    const auto judged_truth = judged(left_truth_, right_truth_);
    ASSERT_TRUE(judged_truth.has_value());
    EXPECT_EQ(judged_truth->colour_excess, 0.0);
    EXPECT_EQ(judged_truth->rivalry_fraction, 0.0);
    EXPECT_EQ(judged_truth->vertical_disparity_px, 0.0);
}

TEST_F(EyeConsistencyTest, AnErrorThatBothEyesShareIsConsistent) {
    const auto dimmed = [](double x, double y) { return waves(x, y) - 0.1; };
    const auto result = judged(painted(left_, 0.0, dimmed), painted(right_, 2.0, dimmed));
    ASSERT_TRUE(result.has_value());
    EXPECT_LT(result->colour_excess, 0.5 / 255.0) << "but for rounding to eight bits";
}

TEST_F(EyeConsistencyTest, AnErrorOfOneEyeIsItsExcess) {
    const auto dimmed = [](double x, double y) { return waves(x, y) - 0.1; };
    const auto result = judged(left_truth_, painted(right_, 2.0, dimmed));
    ASSERT_TRUE(result.has_value());
    // The card, a quarter of the picture's pairs, is as it was.
    EXPECT_GT(result->colour_excess, 0.05);
    EXPECT_LT(result->colour_excess, 0.1);
}

TEST_F(EyeConsistencyTest, APixelMadeUpInOneEyeIsRivalryUnlessTheOtherMadeItUpToo) {
    left_invented_.at(2 + 4, 10) = 1;
    const auto one = judged(left_truth_, right_truth_);
    ASSERT_TRUE(one.has_value());
    EXPECT_GT(one->rivalry_fraction, 0.0);
    right_invented_.at(4, 10) = 1;
    const auto both = judged(left_truth_, right_truth_);
    ASSERT_TRUE(both.has_value());
    EXPECT_EQ(both->rivalry_fraction, 0.0);
}

TEST_F(EyeConsistencyTest, AMadeUpPixelThatTheOtherEyeDoesNotSeeIsNoRivalry) {
    // Right beside the card the left eye sees wall that the card hides from the right eye.
    const auto hidden = [&](int x) { return !left_.is_card(x, 10) && right_.is_card(x - 2, 10); };
    int x = 1;
    while (x < kSide_px && !(hidden(x - 1) && hidden(x) && hidden(x + 1))) ++x;
    ASSERT_LT(x, kSide_px);
    left_invented_.at(x, 10) = 1;
    const auto result = judged(left_truth_, right_truth_);
    ASSERT_TRUE(result.has_value());
    EXPECT_EQ(result->rivalry_fraction, 0.0);
}

TEST_F(EyeConsistencyTest, APictureThatIsLowerInOneEyeIsMeasured) {
    for (const double lower_px : {-0.4, 0.1, 0.3}) {
        const auto lowered = [&](double x, double y) { return waves(x, y - lower_px); };
        const auto result = judged(left_truth_, painted(right_, 2.0, lowered));
        ASSERT_TRUE(result.has_value() && result->vertical_disparity_px.has_value());
        // First order in the shift, central differences, eight bits: within a tenth.
        EXPECT_NEAR(*result->vertical_disparity_px, std::abs(lower_px), 0.1 * std::abs(lower_px));
    }
}

TEST_F(EyeConsistencyTest, WhatScattersIsNoDisplacement) {
    // Each pixel a tenth brighter or darker, in one eye alone: as edges do that are sampled otherwise.
    const auto scattered = [](double x, double y) {
        const auto number = static_cast<unsigned>(x) * 73856093U ^ static_cast<unsigned>(y) * 19349663U;
        return waves(x, y) + 0.1 * ((number >> 4U) % 3U - 1.0);
    };
    const auto result = judged(left_truth_, painted(right_, 2.0, scattered));
    ASSERT_TRUE(result.has_value());
    EXPECT_GT(result->colour_excess, 0.03);
    // The part is left out, or known to lie right within its standard error.
    if (result->vertical_disparity_px) {
        EXPECT_LT(*result->vertical_disparity_px, 0.04);
    }
}

TEST_F(EyeConsistencyTest, WithoutTextureNoVerticalDisparityIsKnown) {
    const auto plain = [](double, double) { return 0.5; };
    left_truth_ = painted(left_, 0.0, plain);
    right_truth_ = painted(right_, 2.0, plain);
    const auto result = judged(left_truth_, right_truth_);
    ASSERT_TRUE(result.has_value());
    EXPECT_FALSE(result->vertical_disparity_px.has_value());
}

TEST_F(EyeConsistencyTest, EyesThatSeeNothingInCommonHaveNoPairs) {
    right_ = draw_cards({}, card_camera(1000.0, kSide_px));
    EXPECT_FALSE(judged(left_truth_, right_truth_).has_value());
}

}  // namespace
}  // namespace lw::test
