#include "core/flicker.h"

#include <gtest/gtest.h>

#include "tests/core/card_scene.h"

namespace lw::test {
namespace {

ColourImage plain(std::uint8_t level) { return ColourImage{{64, 64}, {level, level, level, 255}}; }

TEST(Flicker, AnErrorThatRestsDoesNotFlicker) {
    const CardPicture picture = draw_cards({}, card_camera(0.0));
    const Image<int> before = pixels_before(picture.view(), picture.view(), 1);
    EXPECT_EQ(flicker(plain(100), plain(90), plain(50), plain(40), before), 0.0);
}

TEST(Flicker, AnErrorThatTurnsIsMeasured) {
    const CardPicture picture = draw_cards({}, card_camera(0.0));
    const Image<int> before = pixels_before(picture.view(), picture.view(), 1);
    // 10 levels too bright, then 10 too dark.
    EXPECT_NEAR(flicker(plain(100), plain(90), plain(100), plain(110), before).value_or(0.0), 20.0 / 255.0, 1e-12);
}

TEST(Flicker, AnErrorThatMovesWithItsSurfaceDoesNotFlicker) {
    // The head moves so that the wall moves by 2 px and the card by 10; both carry a spot of error along.
    const CardPicture before = draw_cards({}, card_camera(0.0));
    const CardPicture now = draw_cards({}, card_camera(0.625));
    const ColourImage truth = plain(100);
    ColourImage shown_before = truth;
    ColourImage shown_now = truth;
    shown_before.at(10, 10) = {180, 100, 100, 255};
    shown_now.at(8, 10) = {180, 100, 100, 255};
    shown_before.at(30, 10) = {100, 30, 100, 255};  // on the card
    shown_now.at(20, 10) = {100, 30, 100, 255};
    const Image<int> map = pixels_before(now.view(), before.view(), 1);
    EXPECT_EQ(map.at(8, 10), 10 * 64 + 10);
    EXPECT_EQ(map.at(20, 10), 10 * 64 + 30);
    EXPECT_EQ(map.at(31, 10), -1) << "wall that the card hid before";
    EXPECT_EQ(flicker(truth, shown_now, truth, shown_before, map), 0.0);
    EXPECT_GT(flicker(truth, shown_now, truth, truth, map).value_or(0.0), 0.0);
}

TEST(Flicker, WithoutCommonPixelsThereIsNone) {
    const ColourImage grey = plain(100);
    EXPECT_FALSE(flicker(grey, grey, grey, grey, Image<int>{{64, 64}, -1}).has_value());
}

}  // namespace
}  // namespace lw::test
