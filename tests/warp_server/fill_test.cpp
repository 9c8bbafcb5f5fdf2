#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "warp_server/fill.h"

namespace lw {
namespace {

constexpr Rgba8 kNear{200, 10, 10, 255};
constexpr Rgba8 kFar{10, 10, 200, 255};

// Each character is a pixel: '#' near, '.' far, ' ' hole.
DisplayFrame frame_of(const std::vector<std::string>& rows) {
    DisplayFrame frame;
    frame.resize({static_cast<int>(rows.front().size()), static_cast<int>(rows.size())});
    for (int y = 0; y < frame.colour.height(); ++y) {
        for (int x = 0; x < frame.colour.width(); ++x) {
            const char c = rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x)];
            frame.colour.at(x, y) = c == '#' ? kNear : kFar;
            frame.depth.at(x, y) = c == '#' ? 0.1F : 0.01F;
            frame.coverage.at(x, y) = c == ' ' ? Coverage::hole : Coverage::reached;
            if (c == ' ') frame.colour.at(x, y) = Rgba8{1, 2, 3, 4};
        }
    }
    return frame;
}

std::vector<std::string> text_of(const DisplayFrame& frame) {
    std::vector<std::string> rows;
    for (int y = 0; y < frame.colour.height(); ++y) {
        std::string row;
        for (int x = 0; x < frame.colour.width(); ++x) {
            const Rgba8 colour = frame.colour.at(x, y);
            row += colour == kNear ? '#' : colour == kFar ? '.' : '?';
        }
        rows.push_back(row);
    }
    return rows;
}

std::vector<std::string> filled(const std::vector<std::string>& rows) {
    DisplayFrame frame = frame_of(rows);
    auto fill = make_fill("nearest-background");
    (*fill)->apply(frame);
    EXPECT_THAT(frame.coverage.pixels(), ::testing::Not(::testing::Contains(Coverage::hole)));
    return text_of(frame);
}

using Rows = std::vector<std::string>;

TEST(NearestBackgroundFill, TakesTheFartherSide) {
    EXPECT_EQ(filled({"##    .."}), Rows{"##......"});
    EXPECT_EQ(filled({"..    ##"}), Rows{"......##"});
}

TEST(NearestBackgroundFill, ClosesACrackInsideASurface) {
    EXPECT_EQ(filled({"###", "# #", "###"}), (Rows{"###", "###", "###"}));
}

TEST(NearestBackgroundFill, WorksAlongColumnsAndAtBorders) {
    EXPECT_EQ(filled({" ", " ", "#"}), (Rows{"#", "#", "#"}));
    EXPECT_EQ(filled({"#", " ", " ", "."}), (Rows{"#", ".", ".", "."}));
    EXPECT_EQ(filled({"  .."}), Rows{"...."});
}

TEST(NearestBackgroundFill, TakesTheNearerOfRowAndColumn) {
    // The middle pixel is one row from the near surface but four columns from the far one.
    EXPECT_EQ(filled({"#########", ".       .", "#########"})[1][4], '#');
}

TEST(NearestBackgroundFill, AFrameOfHolesBecomesGrey) {
    DisplayFrame frame = frame_of({"   ", "   "});
    auto fill = make_fill("nearest-background");
    (*fill)->apply(frame);
    EXPECT_THAT(frame.colour.pixels(), ::testing::Each(Rgba8{128, 128, 128, 255}));
    EXPECT_THAT(frame.depth.pixels(), ::testing::Each(0.0F));
}

TEST(NoFill, ShowsHolesAsGrey) {
    DisplayFrame frame = frame_of({"# ."});
    EXPECT_DOUBLE_EQ(hole_fraction(frame), 1.0 / 3.0);
    auto fill = make_fill("none");
    (*fill)->apply(frame);
    EXPECT_EQ(frame.colour.at(1, 0), (Rgba8{128, 128, 128, 255}));
    EXPECT_EQ(frame.coverage.at(1, 0), Coverage::filled);
    EXPECT_EQ(frame.coverage.at(0, 0), Coverage::reached);
    EXPECT_DOUBLE_EQ(hole_fraction(frame), 1.0 / 3.0);  // a filled hole is still one that no pixel reached
}

TEST(Fill, UnknownNamesAreErrors) {
    const auto fill = make_fill("magic");
    ASSERT_FALSE(fill.ok());
    EXPECT_EQ(fill.error().message(), "unknown fill: magic: one of: none, nearest-background");
    EXPECT_DOUBLE_EQ(hole_fraction(DisplayFrame{}), 0.0);
}

}  // namespace
}  // namespace lw
