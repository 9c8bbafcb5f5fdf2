#include "warp_server/virtual_display.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/image_io.h"
#include "warp_server/png_presenter.h"

namespace lw {
namespace {

TEST(VirtualDisplay, TheNextRefreshBeginsAfterNow) {
    for (const double hz : {25.0, 60.0, 72.0, 90.0, 120.0, 144.0}) {
        const VirtualDisplay display{at_seconds(3.0), hz, {1, 1}};
        std::uint64_t expected = 1;
        TimePoint now = at_seconds(3.0);
        for (int i = 0; i < 2000; ++i) {
            const Refresh refresh = display.next_refresh(now);
            ASSERT_EQ(refresh.number, expected) << hz << " Hz";
            ASSERT_GT(refresh.scanout_begin, now);
            // One nanosecond of rounding.
            ASSERT_NEAR(seconds_of(refresh.scanout_begin), 3.0 + static_cast<double>(expected) / hz, 1.1e-9);
            now = refresh.scanout_begin;
            ++expected;
        }
    }
}

TEST(VirtualDisplay, NoDriftAfterAnHour) {
    const VirtualDisplay display{TimePoint{}, 90.0, {1, 1}};
    const Refresh refresh = display.next_refresh(at_seconds(3600.0) - from_ms(1.0));
    EXPECT_EQ(refresh.number, 324000u);
    EXPECT_EQ(refresh.scanout_begin, at_seconds(3600.0));
}

TEST(VirtualDisplay, BeforeItsStartTheFirstScanoutIsNext) {
    const VirtualDisplay display{at_seconds(1.0), 90.0, {1, 1}};
    EXPECT_EQ(display.next_refresh(at_seconds(0.0)).number, 0u);
    EXPECT_EQ(display.next_refresh(at_seconds(0.0)).scanout_begin, at_seconds(1.0));
}

TEST(VirtualDisplay, PhotonsLeaveInTheMiddleOfTheScanout) {
    const VirtualDisplay display{TimePoint{}, 50.0, {1, 1}};
    const Refresh refresh = display.next_refresh(TimePoint{});
    EXPECT_EQ(refresh.photon(), at_seconds(0.03));
}

TEST(VirtualDisplay, KeepsTheLastPicture) {
    VirtualDisplay display{TimePoint{}, 90.0, {2, 2}};
    EXPECT_EQ(display.picture().at(1, 1), (Rgba8{0, 0, 0, 255}));
    DisplayFrame frame;
    frame.resize({2, 2});
    frame.colour.at(1, 0) = Rgba8{1, 2, 3, 255};
    const Refresh refresh = display.next_refresh(TimePoint{});
    display.present(frame, refresh);
    EXPECT_EQ(display.picture(), frame.colour);
    EXPECT_EQ(display.picture_refresh().number, refresh.number);
}

TEST(PngPresenter, WritesEveryOtherPictureAndPassesAllOn) {
    const std::filesystem::path folder = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "png_presenter";
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    VirtualDisplay display{TimePoint{}, 90.0, {4, 4}};
    PngPresenter presenter{display, folder, 2};
    TimePoint now{};
    DisplayFrame frame;
    frame.resize({4, 4});
    for (std::uint8_t i = 0; i < 4; ++i) {
        const Refresh refresh = presenter.next_refresh(now);
        for (Rgba8& pixel : frame.colour.pixels()) pixel = Rgba8{i, 0, 0, 255};
        presenter.present(frame, refresh);
        now = refresh.scanout_begin;
    }
    EXPECT_FALSE(presenter.error());
    EXPECT_EQ(display.picture_refresh().number, 4u);
    EXPECT_TRUE(std::filesystem::exists(folder / "000001.png"));
    EXPECT_FALSE(std::filesystem::exists(folder / "000002.png"));
    const auto third = read_png(folder / "000003.png");
    ASSERT_TRUE(third.ok());
    EXPECT_EQ(third->at(0, 0), (Rgba8{2, 0, 0, 255}));
}

TEST(PngPresenter, ReportsAFolderItCannotWriteToAndGoesOn) {
    VirtualDisplay display{TimePoint{}, 90.0, {4, 4}};
    PngPresenter presenter{display, "/nonexistent-folder/of/no/one"};
    DisplayFrame frame;
    frame.resize({4, 4});
    presenter.present(frame, presenter.next_refresh(TimePoint{}));
    ASSERT_TRUE(presenter.error().has_value());
    EXPECT_EQ(display.picture_refresh().number, 1u);
}

}  // namespace
}  // namespace lw
