#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "core/task_pool.h"
#include "warp_server/fill.h"
#include "warp_server/hole_ends.h"

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

// The source's eye far to the right of the target's: what it hid lies to the left of what hid it.
constexpr FillGuide kBackgroundOnTheLeft{{1e3, 0.0, 0.0}};
constexpr FillGuide kBackgroundOnTheRight{{-1e3, 0.0, 0.0}};
constexpr FillGuide kNoGuide{};

void fill_holes(std::string_view name, DisplayFrame& frame, const FillGuide& guide = kNoGuide) {
    auto fill = make_fill(name);
    ASSERT_TRUE(fill.ok());
    (*fill)->apply(frame, guide);
    EXPECT_THAT(frame.coverage.pixels(), ::testing::Not(::testing::Contains(Coverage::hole)));
}

using Rows = std::vector<std::string>;

Rows filled_by(std::string_view name, const Rows& rows) {
    DisplayFrame frame = frame_of(rows);
    fill_holes(name, frame);
    return text_of(frame);
}

Rows filled(const Rows& rows) { return filled_by("nearest-background", rows); }

// What holds for every fill that looks at depth.
class BackgroundFill : public ::testing::TestWithParam<const char*> {
protected:
    static Rows filled(const Rows& rows) { return filled_by(GetParam(), rows); }
};

INSTANTIATE_TEST_SUITE_P(All, BackgroundFill, ::testing::Values("nearest-background", "pyramid"));

TEST_P(BackgroundFill, TakesTheFartherSide) {
    EXPECT_EQ(filled({"##    .."}), Rows{"##......"});
    EXPECT_EQ(filled({"..    ##"}), Rows{"......##"});
    EXPECT_EQ(filled({"#", " ", " ", "."}), (Rows{"#", ".", ".", "."}));
}

TEST_P(BackgroundFill, ClosesACrackInsideASurface) {
    EXPECT_EQ(filled({"###", "# #", "###"}), (Rows{"###", "###", "###"}));
}

TEST_P(BackgroundFill, FillsUpToTheBorder) {
    EXPECT_EQ(filled({" ", " ", "#"}), (Rows{"#", "#", "#"}));
    EXPECT_EQ(filled({"  .."}), Rows{"...."});
    EXPECT_EQ(filled({"..       "}), Rows{"........."});
}

TEST_P(BackgroundFill, SeesPastTheBarOfARailing) {
    // Bars stand closer to the hole than anything else; the ground below them is what continues behind.
    const Rows shown = filled({"# #  # #", "# #  # #", "........"});
    EXPECT_EQ(shown[0][3], '.');
    EXPECT_EQ(shown[1][4], '.');
}

TEST_P(BackgroundFill, ACornerThatNoRowOrColumnReachesIsNotGrey) {
    const Rows rows = filled({"     ", "     ", "  .  ", "     "});
    for (const std::string& row : rows) EXPECT_EQ(row, ".....");
}

TEST_P(BackgroundFill, LargePicturesOfAnySizeAreFilledWhole) {
    Rows rows(67, std::string(91, '.'));
    for (std::size_t y = 5; y < 60; ++y) {
        for (std::size_t x = 11; x < 80; ++x) rows[y][x] = x < 30 ? '#' : ' ';
    }
    const Rows shown = filled(rows);
    EXPECT_EQ(shown[30], std::string(11, '.') + std::string(19, '#') + std::string(61, '.'));
    EXPECT_EQ(shown[66], std::string(91, '.'));
}

TEST_P(BackgroundFill, AFrameOfHolesBecomesGrey) {
    DisplayFrame frame = frame_of({"   ", "   "});
    fill_holes(GetParam(), frame);
    EXPECT_THAT(frame.colour.pixels(), ::testing::Each(Rgba8{128, 128, 128, 255}));
    EXPECT_THAT(frame.depth.pixels(), ::testing::Each(0.0F));
}

TEST_P(BackgroundFill, AFrameWithoutHolesStaysAsItIs) {
    DisplayFrame frame = frame_of({"#.#", ".#."});
    const DisplayFrame before = frame;
    fill_holes(GetParam(), frame);
    EXPECT_EQ(frame.colour, before.colour);
    EXPECT_EQ(frame.depth, before.depth);
}

TEST_P(BackgroundFill, EqualFramesGiveEqualBytesWhateverCameBefore) {
    const Rows rows{"##    ..", "##   ...", "######  ", "...  ###"};
    auto fill = make_fill(GetParam());
    DisplayFrame first = frame_of(rows);
    (*fill)->apply(first, kBackgroundOnTheLeft);
    DisplayFrame other = frame_of({"    ", " #  "});
    (*fill)->apply(other, kBackgroundOnTheRight);
    DisplayFrame second = frame_of(rows);
    (*fill)->apply(second, kBackgroundOnTheLeft);
    EXPECT_EQ(first.colour, second.colour);
    EXPECT_EQ(first.depth, second.depth);
}

// Blocks of holes, some rows of nothing but holes, every pixel with a colour and a depth of its own.
DisplayFrame frame_with_many_holes() {
    DisplayFrame frame;
    frame.resize({200, 120});
    std::mt19937 random{5};
    for (int y = 0; y < frame.colour.height(); ++y) {
        for (int x = 0; x < frame.colour.width(); ++x) {
            const auto bits = static_cast<std::uint32_t>(random());
            const bool hole = y < 3 || (y > 50 && y < 54) || (x / 17 + y / 13) % 2 == 0;
            frame.coverage.at(x, y) = hole ? Coverage::hole : Coverage::reached;
            frame.colour.at(x, y) = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8U),
                                     static_cast<std::uint8_t>(bits >> 16U), 255};
            frame.depth.at(x, y) = 0.01F * static_cast<float>(1 + bits % 97);
        }
    }
    return frame;
}

TEST(NearestBackgroundFill, AnyNumberOfThreadsGivesTheSamePicture) {
    DisplayFrame alone = frame_with_many_holes();
    fill_holes("nearest-background", alone);
    for (const int threads : {1, 2, 3}) {
        TaskPool pool{threads};
        auto fill = make_fill("nearest-background");
        (*fill)->work_on(&pool);
        for (int repeat = 0; repeat < 2; ++repeat) {
            DisplayFrame frame = frame_with_many_holes();
            ASSERT_LT(HoleEnds::kWorthThreads, hole_fraction(frame) * static_cast<double>(frame.depth.pixels().size()));
            (*fill)->apply(frame, kNoGuide);
            EXPECT_EQ(frame.colour, alone.colour) << threads;
            EXPECT_EQ(frame.depth, alone.depth) << threads;
            EXPECT_EQ(frame.coverage, alone.coverage) << threads;
        }
    }
}

TEST(NearestBackgroundFill, OfRowAndColumnTakesTheFartherToo) {
    // The middle pixel is one row from the near surface and four columns from the far one.
    EXPECT_EQ(filled({"#########", ".       .", "#########"})[1], ".........");
}

// Two walls at one depth, red on the left and blue on the right of a hole.
DisplayFrame two_walls(int width, int height, int hole_begin, int hole_end) {
    DisplayFrame frame;
    frame.resize({width, height});
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool is_hole = x >= hole_begin && x < hole_end;
            frame.colour.at(x, y) = x < hole_begin ? Rgba8{200, 0, 0, 255} : Rgba8{0, 0, 200, 255};
            frame.depth.at(x, y) = 0.01F;
            frame.coverage.at(x, y) = is_hole ? Coverage::hole : Coverage::reached;
        }
    }
    return frame;
}

double mean_red(const DisplayFrame& frame, int begin, int end) {
    double sum = 0.0;
    for (int y = 0; y < frame.colour.height(); ++y) {
        for (int x = begin; x < end; ++x) sum += frame.colour.at(x, y).r;
    }
    return sum / (frame.colour.height() * (end - begin));
}

TEST(PyramidFill, LeansTowardsTheBackgroundSideOfTheEpipolarLine) {
    DisplayFrame left = two_walls(64, 64, 28, 36);
    fill_holes("pyramid", left, kBackgroundOnTheLeft);
    DisplayFrame right = two_walls(64, 64, 28, 36);
    fill_holes("pyramid", right, kBackgroundOnTheRight);
    EXPECT_GT(mean_red(left, 28, 36), 2.0 * mean_red(right, 28, 36));
}

// A hole in a picture whose brightness rises from left to right.
DisplayFrame hole_in_a_ramp(int hole_begin) {
    DisplayFrame frame = two_walls(128, 32, hole_begin, hole_begin + 12);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 128; ++x) {
            const auto level = static_cast<std::uint8_t>(64 + x);
            frame.colour.at(x, y) = {level, level, level, 255};
        }
    }
    return frame;
}

TEST(PyramidFill, AHoleThatWandersDoesNotCrawl) {
    // What is shown in the middle of a hole follows the surroundings, wherever the pyramid's cells begin. A step of
    // one pixel changes the ramp by one level; a coarser level's own cells are up to eight pixels wide.
    for (int begin = 32; begin < 64; ++begin) {
        DisplayFrame a = hole_in_a_ramp(begin);
        DisplayFrame b = hole_in_a_ramp(begin + 1);
        fill_holes("pyramid", a);
        fill_holes("pyramid", b);
        EXPECT_NEAR(a.colour.at(begin + 6, 16).r, b.colour.at(begin + 6, 16).r, 8) << begin;
        EXPECT_NEAR(a.colour.at(begin + 6, 16).r, 64 + begin + 6, 8) << begin;
    }
}

TEST(FillGuide, PointsAwayFromWhatHidTheBackground) {
    Camera source;
    source.fov = FovTangents::symmetric(1.57, 1.0);
    source.size_px = {100, 100};
    Camera target = source;
    // The head moves right: things move left in the picture, the near ones farther, so background opens on their right.
    target.world_from_eye.position_m = {0.1, 0.0, 0.0};
    const glm::dvec2 right = fill_guide(source, target).background_px_m({30.0, 80.0});
    EXPECT_GT(right.x, 0.0);
    EXPECT_NEAR(right.y, 0.0, 1e-9);
    // Forward: near things grow outwards and uncover towards the centre. Backward: the other way round.
    target.world_from_eye.position_m = {0.0, 0.0, -0.1};
    const glm::dvec2 inwards = fill_guide(source, target).background_px_m({70.0, 60.0});
    EXPECT_LT(inwards.x, 0.0);
    EXPECT_LT(inwards.y, 0.0);
    target.world_from_eye.position_m = {0.0, 0.0, 0.1};
    EXPECT_GT(fill_guide(source, target).background_px_m({70.0, 60.0}).x, 0.0);
    // The parallax of a point says the same: it moves by background_px_m / distance against the far background.
    target = source;
    target.world_from_eye.position_m = {0.05, -0.02, 0.0};
    EXPECT_EQ(fill_guide(source, source).background_px_m({70.0, 60.0}), glm::dvec2{0.0});
    const auto moved_by = fill_guide(source, target).background_px_m({50.0, 50.0});
    const double focal_px = 50.0 / source.fov.right;
    EXPECT_NEAR(moved_by.x, 0.05 * focal_px, 1e-9);
    EXPECT_NEAR(moved_by.y, 0.02 * focal_px, 1e-9);
}

TEST(NoFill, ShowsHolesAsGrey) {
    DisplayFrame frame = frame_of({"# ."});
    EXPECT_DOUBLE_EQ(hole_fraction(frame), 1.0 / 3.0);
    fill_holes("none", frame);
    EXPECT_EQ(frame.colour.at(1, 0), (Rgba8{128, 128, 128, 255}));
    EXPECT_EQ(frame.coverage.at(1, 0), Coverage::filled);
    EXPECT_EQ(frame.coverage.at(0, 0), Coverage::reached);
    EXPECT_DOUBLE_EQ(hole_fraction(frame), 1.0 / 3.0);  // a filled hole is still one that no pixel reached
}

TEST(Fill, UnknownNamesAreErrors) {
    const auto fill = make_fill("magic");
    ASSERT_FALSE(fill.ok());
    EXPECT_EQ(fill.error().message(), "unknown fill: magic: one of: none, nearest-background, pyramid");
    EXPECT_DOUBLE_EQ(hole_fraction(DisplayFrame{}), 0.0);
}

}  // namespace
}  // namespace lw
