#include "apps/overlay.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "apps/demo_controls.h"
#include "tests/warp_server/simulated_display.h"
#include "warp_server/methods/registry.h"

namespace lw {
namespace {

std::size_t count(const ColourImage& image, Rgba8 colour) {
    return static_cast<std::size_t>(std::count(image.pixels().begin(), image.pixels().end(), colour));
}

TEST(Overlay, TextLeavesInkAndStaysInside) {
    const Rgba8 paper = text_panel({""}, 100, 1).at(0, 0);
    EXPECT_EQ(count(text_panel({""}, 100, 1), paper), 100u * 14u);
    const ColourImage line = text_panel({"HELP"}, 100, 1);
    EXPECT_GT(100u * 14u - count(line, paper), 40u);
    const ColourImage cut = text_panel({std::string(200, 'M')}, 60, 2);
    EXPECT_EQ(cut.width(), 60);
}

TEST(Overlay, ABarIsAsLongAsItsValueAndRedBeyondItsTarget) {
    const Rgba8 good{90, 190, 120, 255};
    const Rgba8 bad{225, 90, 80, 255};
    const ColourImage half = bar_panel({{"A", 5.0, 10.0, 8.0}}, 400, 1);
    const ColourImage most = bar_panel({{"A", 9.0, 10.0, 8.0}}, 400, 1);
    EXPECT_GT(count(half, good), 0u);
    EXPECT_EQ(count(half, bad), 0u);
    EXPECT_EQ(count(most, good), 0u);
    // 9 of 10 less the mark, 7 rows high, beside 5 of 10.
    EXPECT_NEAR(static_cast<double>(count(most, bad)) / static_cast<double>(count(half, good)), 1.8, 0.05);
}

Camera small_camera() {
    Camera camera;
    camera.size_px = {4, 4};
    return camera;
}

TEST(DemoControls, TheMethodChangesAtTheNextPicture) {
    DemoControls controls;
    auto method = make_demo_method("splat", controls);
    ASSERT_TRUE(method.ok());
    const auto source = test::plain_frame(1, TimePoint{}, Rgba8{9, 8, 7, 255});
    const Layer& layer = *source->layers.front();
    const auto labels = (*method)->labels();
    EXPECT_EQ(labels.front(), "splat");
    EXPECT_GE(labels.size(), 4u);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        controls.method = i;
        EXPECT_EQ((*method)->label(), labels[i]);
        DisplayFrame shown;
        (*method)->warp(layer, {small_camera(), {}}, shown);
        DisplayFrame expected;
        (*make_warp_method(labels[i]))->warp(layer, {small_camera(), {}}, expected);
        EXPECT_EQ(shown.colour, expected.colour) << labels[i];
    }
}

TEST(DemoControls, HolesAreMagentaWhenTheyAreToBeSeen) {
    DemoControls controls;
    const auto fill = make_demo_fill(*make_fill("nearest-background"), controls);
    DisplayFrame frame;
    frame.resize({4, 4});
    std::fill(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::reached);
    std::fill(frame.colour.pixels().begin(), frame.colour.pixels().end(), Rgba8{1, 2, 3, 255});
    frame.coverage.at(2, 1) = Coverage::hole;
    DisplayFrame filled = frame;
    fill->apply(filled, {});
    EXPECT_EQ(filled.colour.at(2, 1), (Rgba8{1, 2, 3, 255}));
    controls.holes_shown = true;
    fill->apply(frame, {});
    EXPECT_EQ(frame.colour.at(2, 1), (Rgba8{255, 0, 255, 255}));
    EXPECT_EQ(frame.colour.at(1, 1), (Rgba8{1, 2, 3, 255}));
}

}  // namespace
}  // namespace lw
