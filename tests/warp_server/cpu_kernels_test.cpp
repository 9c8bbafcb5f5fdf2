/// The vector loops of the CPU methods: every instruction set and any number of threads give the same bytes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <atomic>
#include <limits>

#include "core/colour.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/fill.h"
#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/methods/surface_cells.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw::test {
namespace {

// Runs with one instruction set at a time, and puts the best one back.
class InstructionSets {
public:
    InstructionSets() : targets_{hwy::SupportedAndGeneratedTargets()} {}
    ~InstructionSets() { hwy::SetSupportedTargetsForTest(0); }
    [[nodiscard]] const std::vector<std::int64_t>& all() const { return targets_; }
    static void use(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }

private:
    std::vector<std::int64_t> targets_;
};

bool same_pixels(const DisplayFrame& a, const DisplayFrame& b) {
    for (std::size_t i = 0; i < a.coverage.pixels().size(); ++i) {
        if (a.coverage.pixels()[i] != b.coverage.pixels()[i]) return false;
        if (a.coverage.pixels()[i] == Coverage::hole) continue;
        if (a.colour.pixels()[i] != b.colour.pixels()[i] || a.depth.pixels()[i] != b.depth.pixels()[i]) return false;
    }
    return true;
}

class VectorFill : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, VectorFill, ::testing::Values("nearest-background", "pyramid"));

TEST_P(VectorFill, EveryInstructionSetGivesTheSameBytes) {
    const AnalyticScene scene = AnalyticScene::street();
    InstructionSets sets;
    for (const glm::ivec2& size_px : {glm::ivec2{131, 67}, glm::ivec2{160, 128}, glm::ivec2{5, 3}}) {
        const Camera source = street_camera(size_px);
        const Camera target = moved(source, {0.15, 0.01, -0.06}, 3.0, 1.0, 2.0);
        const DisplayFrame warped = warp_once("splat", scene.draw(source, 0.0), {target, scene.movers(0.1)});
        DisplayFrame best = warped;
        (*make_fill(GetParam()))->apply(best, fill_guide(source, target));
        for (const std::int64_t set : sets.all()) {
            InstructionSets::use(set);
            DisplayFrame frame = warped;
            (*make_fill(GetParam()))->apply(frame, fill_guide(source, target));
            EXPECT_TRUE(same_pixels(frame, best)) << hwy::TargetName(set) << " " << size_px.x << "x" << size_px.y;
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

class VectorMethod : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, VectorMethod, ::testing::Values("splat", "surface", "inverse"));

TEST_P(VectorMethod, EveryInstructionSetGivesTheSameBytes) {
    const AnalyticScene scene = AnalyticScene::street();
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    InstructionSets sets;
    for (const glm::ivec2& size_px : {glm::ivec2{131, 67}, glm::ivec2{5, 3}, glm::ivec2{1, 1}}) {
        const Camera source = street_camera(size_px);
        const Camera target = moved(source, {0.05, 0.01, -0.06}, 3.0, 1.0, 2.0);
        const Layer layer = scene.draw(source, 0.0);
        const DisplayFrame best = warp_once(GetParam(), layer, {target, movers});
        for (const std::int64_t set : sets.all()) {
            InstructionSets::use(set);
            const DisplayFrame frame = warp_once(GetParam(), layer, {target, movers});
            EXPECT_TRUE(same_pixels(frame, best)) << hwy::TargetName(set) << " " << size_px.x << "x" << size_px.y;
        }
        hwy::SetSupportedTargetsForTest(0);
    }
}

class Resampling : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, Resampling, ::testing::Values("stale", "rotation"));

TEST_P(Resampling, EveryInstructionSetGivesTheSameBytesAndCounts) {
    const AnalyticScene scene = AnalyticScene::street();
    InstructionSets sets;
    for (const glm::ivec2& size_px : {glm::ivec2{131, 67}, glm::ivec2{160, 128}, glm::ivec2{5, 3}, glm::ivec2{1, 1}}) {
        const Camera source = street_camera(size_px);
        Layer layer = scene.draw(source, 0.0);
        const std::span<float> depths = layer.cpu().depth.pixels();
        for (std::size_t i = 3; i < depths.size(); i += 61) depths[i] = kNoSurfaceDepth;
        for (std::size_t i = 7; i < depths.size(); i += 67) depths[i] = std::numeric_limits<float>::quiet_NaN();
        layer.empty_pixels = 1;
        for (const double roll_deg : {0.0, 2.0, 70.0}) {
            const WarpTarget target{moved(source, {}, 3.0, 1.0, roll_deg), {}};
            const auto method = method_named(GetParam());
            DisplayFrame best;
            method->warp(layer, target, best);
            const std::uint64_t bad_depths = method->counters().bad_depth;
            EXPECT_TRUE(size_px.x < 100 || bad_depths > 50);
            for (const std::int64_t set : sets.all()) {
                InstructionSets::use(set);
                DisplayFrame frame;
                method->warp(layer, target, frame);
                EXPECT_TRUE(same_pixels(frame, best)) << hwy::TargetName(set) << " " << size_px.x << "x" << size_px.y;
                EXPECT_EQ(method->counters().bad_depth, bad_depths) << hwy::TargetName(set);
            }
            hwy::SetSupportedTargetsForTest(0);
        }
    }
}

TEST(SurfaceMethod, EveryInstructionSetReadsQuartersTheSame) {
    const AnalyticScene scene = AnalyticScene::street();
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    const Camera source = street_camera({131, 67});
    const Camera target = moved(source, {0.05, 0.01, -0.06}, 3.0, 1.0, 2.0);
    Layer layer = scene.draw(source, 0.0);
    Camera twice = source;
    twice.size_px *= 2;
    CpuPixels& pixels = layer.cpu();
    pixels.quarters = scene.draw(twice, 0.0).cpu().colour;
    InstructionSets sets;
    for (const bool has_shares : {false, true}) {
        pixels.alpha_is_share = has_shares;
        for (std::size_t i = 0; has_shares && i < pixels.colour.pixels().size(); i += 3) {
            const auto x = 2 * (static_cast<int>(i) % source.size_px.x);
            const auto y = 2 * (static_cast<int>(i) / source.size_px.x);
            pixels.colour.pixels()[i].a = 160;
            pixels.quarters.at(x, y).a = 130;
            pixels.quarters.at(x + 1, y).a = 0;
        }
        DisplayFrame straight;
        for (const int samples : {1, 4}) {
            pixels.quarter_samples = samples;
            const DisplayFrame best = warp_once("surface", layer, {target, movers});
            for (const std::int64_t set : sets.all()) {
                InstructionSets::use(set);
                EXPECT_TRUE(same_pixels(warp_once("surface", layer, {target, movers}), best)) << hwy::TargetName(set);
            }
            hwy::SetSupportedTargetsForTest(0);
            EXPECT_NE(best.colour, straight.colour) << samples;
            straight = best;
        }
    }
}

TEST_P(VectorMethod, AnyNumberOfThreadsGivesTheSameBytes) {
    const AnalyticScene scene = AnalyticScene::street();
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    const Camera source = street_camera({160, 121});
    const Camera target = moved(source, {0.05, 0.01, -0.06}, 3.0, 1.0, 8.0);
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame alone = warp_once(GetParam(), layer, {target, movers});
    for (const char* threads : {"2", "3", "16"}) {
        const auto method = method_named(GetParam() + ":threads=" + threads);
        DisplayFrame frame;
        for (int repeat = 0; repeat < 3; ++repeat) {
            method->warp(layer, {target, movers}, frame);
            ASSERT_TRUE(same_pixels(frame, alone)) << threads << " threads, repeat " << repeat;
        }
    }
}

TEST(RowBands, BandsMeetAndCoverAllRows) {
    for (const int rows : {0, 1, 7, 1024}) {
        int next = 0;
        for (int i = 0; i < 3; ++i) {
            const RowRange band = band_of_rows(rows, i, 3);
            EXPECT_EQ(band.begin, next);
            next = band.end;
        }
        EXPECT_EQ(next, rows);
    }
}

TEST(RowBands, BandsOfCostMeetAndShareTheCost) {
    const std::vector<float> cost_until{0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 2.0F, 3.0F, 4.0F};  // all of it in rows 3 to 6
    EXPECT_EQ(band_of_cost(cost_until, 0, 2).begin, 0);
    EXPECT_EQ(band_of_cost(cost_until, 0, 2).end, 5);
    EXPECT_EQ(band_of_cost(cost_until, 1, 2).begin, 5);
    EXPECT_EQ(band_of_cost(cost_until, 1, 2).end, 7);
    const std::vector<float> nothing(9, 0.0F);
    int next = 0;
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(band_of_cost(nothing, i, 3).begin, next);
        next = band_of_cost(nothing, i, 3).end;
    }
    EXPECT_EQ(next, 8);
}

TEST(LinearColour, GivesEveryStoredColourBack) {
    ColourImage image{{256, 1}};
    for (int i = 0; i < 256; ++i) {
        const auto value = static_cast<std::uint8_t>(i);
        image.at(i, 0) = {value, static_cast<std::uint8_t>(255 - i), value, 255};
    }
    const LinearImage linear{image};
    for (int i = 0; i < 256; ++i) {
        const std::uint16_t* red = linear.data() + i;
        EXPECT_EQ(srgb8_from_linear15(red[0], srgb_parabolas()), i);
        EXPECT_EQ(srgb8_from_linear15(red[linear.channel_stride()], srgb_parabolas()), 255 - i);
        EXPECT_EQ(srgb8_from_linear15_table()[red[2 * linear.channel_stride()]], i);
    }
}

TEST(LinearColour, EveryInstructionSetGivesTheSameValuesWithZerosBehind) {
    InstructionSets sets;
    for (const int width : {1, 31, 32, 100}) {
        ColourImage image{{width, 3}};
        for (std::size_t i = 0; i < image.pixels().size(); ++i) {
            const auto value = static_cast<std::uint8_t>(7 * i + 3);
            const auto alpha = static_cast<std::uint8_t>(255 - 5 * i);
            image.pixels()[i] = {value, static_cast<std::uint8_t>(value + 90), static_cast<std::uint8_t>(~value),
                                 alpha};
        }
        const LinearImage best{image, LinearAlpha::kept};
        const auto count =
            static_cast<std::size_t>(best.row_stride()) * static_cast<std::size_t>(3 + LinearImage::kSpareRows);
        for (const std::int64_t set : sets.all()) {
            InstructionSets::use(set);
            const LinearImage linear{image, LinearAlpha::kept};
            EXPECT_TRUE(std::equal(best.data(), best.data() + count, linear.data())) << hwy::TargetName(set);
        }
        EXPECT_EQ(best.data()[width], 0);
        EXPECT_EQ(best.data()[3 * best.channel_stride()], kLinearOne);
        hwy::SetSupportedTargetsForTest(0);
    }
}

TEST(LinearColour, FollowsTheExactCurve) {
    for (int linear15 = 0; linear15 <= kLinearOne; ++linear15) {
        const double exact = 255.0 * srgb_from_linear(static_cast<double>(linear15) / kLinearOne);
        // Half a step of rounding, and a tenth for the parabolas.
        ASSERT_NEAR(srgb8_from_linear15(linear15, srgb_parabolas()), exact, 0.6) << linear15;
    }
}

TEST(SurfaceLinks, PlanesAreOneSurfaceAtAnySlant) {
    EXPECT_TRUE(on_one_surface(0.010F, 0.020F, 0.030F, 0.040F));  // a floor towards the horizon
    EXPECT_TRUE(on_one_surface(0.5F, 0.020F, 0.030F, 0.040F));    // beside an edge on one side
    EXPECT_TRUE(on_one_surface(0.5F, 0.0200F, 0.0201F, 0.6F));    // a strip two pixels wide
    EXPECT_FALSE(on_one_surface(0.02F, 0.02F, 0.03F, 0.03F));     // a step
    EXPECT_FALSE(on_one_surface(0.0F, 0.0F, 0.001F, 0.002F));     // the horizon
    EXPECT_TRUE(on_one_surface(0.0F, 0.0F, 0.0F, 0.0F));          // background
    EXPECT_FALSE(on_one_surface(0.02F, -1.0F, 0.02F, 0.02F));     // unusable
    // A step that cannot be seen.
    EXPECT_TRUE(on_one_surface(0.02F, 0.02F, 0.03F, 0.03F, 0.011F));
    EXPECT_FALSE(on_one_surface(0.02F, 0.02F, 0.03F, 0.03F, 0.009F));
    EXPECT_FALSE(on_one_surface(0.0F, 0.0F, 0.001F, 0.002F, 0.01F));  // the horizon stays one
}

TEST(SurfaceCells, CornersAreGroupedByTheirLinks) {
    EXPECT_EQ(corner_groups(0).count, 4);
    EXPECT_EQ(corner_groups(kLinkTop | kLinkBottom).count, 2);
    EXPECT_EQ(corner_groups(kLinkTop | kLinkBottom).corners[0], 0b0011);
    EXPECT_EQ(corner_groups(kLinkTop | kLinkBottom).corners[1], 0b1100);
    EXPECT_EQ(corner_groups(kLinkTop | kLinkLeft | kLinkRight).count, 1);
    EXPECT_EQ(corner_groups(kLinkFalling | kLinkRising).count, 2);
    for (int sides = 0; sides < 16; ++sides) {
        const auto bits = static_cast<std::uint8_t>(sides);
        EXPECT_EQ(joins_all_corners(bits), corner_groups(bits).count == 1) << sides;
    }
}

TEST(SurfaceClassify, AWallIsOneStripPerRowOfBlocksAndHasNoEdges) {
    const AnalyticScene scene = AnalyticScene::wall(3.0, 0.4);
    const Layer layer = scene.draw(street_camera({128, 128}), 0.0);
    const auto prepared = classify_surfaces(layer.cpu());
    EXPECT_EQ(prepared->blocks.size(), 2U);
    EXPECT_EQ(prepared->tiles.surfaces.size(), 0U);
    EXPECT_EQ(prepared->patches.size(), 0U);
    EXPECT_EQ(prepared->edges.size(), 0U);
}

// A layer that looks at a wall whose every other row stands out by `relief_m`.
Layer ribbed_wall(double distance_m, double relief_m, ObjectId id) {
    Layer layer = AnalyticScene::wall(distance_m, 0.4).draw(street_camera({128, 128}), 0.0);
    CpuPixels& pixels = layer.cpu();
    const auto depth_at = [&](double metres) { return static_cast<float>(layer.camera.near_m / metres); };
    for (int y = 0; y < 128; ++y) {
        const float depth = depth_at(y % 2 == 0 ? distance_m : distance_m - relief_m);
        for (int x = 0; x < 128; ++x) {
            pixels.depth.at(x, y) = depth;
            pixels.object_id.at(x, y) = id;
        }
    }
    return layer;
}

// 1 / 19.9 m less 1 / 20 m, times 64 pixels per tangent and 10 cm, is 0.0016 px; from 1 to 0.9 m it is 0.7 px.
TEST(SurfaceClassify, ReliefThatCannotBeSeenIsOnePlaneUnlessItMayTurn) {
    const auto prepared = [](const Layer& layer) {
        return classify_surfaces(layer.cpu(), SurfaceUse::cpu_kernels, unseen_depth_step(layer.camera));
    };
    EXPECT_EQ(prepared(ribbed_wall(20.0, 0.1, 0))->blocks.size(), 2U);
    EXPECT_EQ(prepared(ribbed_wall(20.0, 0.1, 0))->patches.size(), 0U);
    EXPECT_EQ(classify_surfaces(ribbed_wall(20.0, 0.1, 0).cpu())->blocks.size(), 0U);  // unless it is asked for
    EXPECT_EQ(prepared(ribbed_wall(1.0, 0.1, 0))->blocks.size(), 0U);
    EXPECT_GT(prepared(ribbed_wall(20.0, 0.1, 7))->patches.size(), 1000U);
}

}  // namespace
}  // namespace lw::test
