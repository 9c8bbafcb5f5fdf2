/// What `splat` works out before it places points: blocks and tiles of a layer, and where their points can land.

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <random>

#include "tests/warp_server/analytic_scene.h"
#include "warp_server/methods/splat_footprint.h"
#include "warp_server/methods/splat_parts.h"
#include "warp_server/methods/splat_reach.h"
#include "warp_server/methods/splat_tiles.h"

namespace lw::test {
namespace {

// 64 x 32 pixels of object 0 at depth 0.1: one tile wide, two bands high.
CpuPixels flat_pixels() {
    const glm::ivec2 size_px{64, 32};
    return {ColourImage{size_px}, DepthImage{size_px, 0.1F}, ObjectIdImage{size_px, ObjectId{0}}};
}

// The runs of the block that begins at (x, y).
std::vector<SplatRun> runs_at(const SplatTiles& tiles, int x, int y) {
    std::vector<SplatRun> found;
    std::ranges::copy_if(tiles.runs, std::back_inserter(found),
                         [&](const SplatRun& run) { return run.x_px == x && run.y_px == y; });
    return found;
}

bool is_smooth_at(const SplatTiles& tiles, int x, int y) {
    const std::vector<SplatRun> runs = runs_at(tiles, x, y);
    return runs.size() == 1 && runs[0].is_smooth();
}

TEST(SplatTiles, SlopesAreTakenToTheNextPixelAndAtTheEndOfTheImageToTheOneBefore) {
    const auto tiles = tiles_of(flat_pixels());
    EXPECT_EQ(tiles->bands(), 2);
    EXPECT_EQ(tiles->runs.size(), 4U * 32U);
    for (const int x : {0, 16, 32}) {
        for (const int y : {0, 1, 15, 16, 30}) EXPECT_TRUE(is_smooth_at(*tiles, x, y)) << x << ", " << y;
    }
    EXPECT_EQ(runs_at(*tiles, 48, 5), (std::vector<SplatRun>{{48, 5, 0, 0xFFFF, 0x7FFF, 0x8000, 0xFFFF, 0}}));
    EXPECT_EQ(runs_at(*tiles, 16, 31), (std::vector<SplatRun>{{16, 31, 0, 0xFFFF, 0xFFFF, 0, 0, 0xFFFF}}));
}

TEST(SplatTiles, EveryObjectOfABlockHasARunAndNoSlopeLeavesIt) {
    CpuPixels pixels = flat_pixels();
    pixels.object_id.at(31, 10) = 7;  // last pixel of its block
    const auto tiles = tiles_of(pixels);
    EXPECT_EQ(runs_at(*tiles, 16, 10),
              (std::vector<SplatRun>{{16, 10, 0, 0x7FFF, 0x3FFF, 0x4000, 0x7FFF, 0}, {16, 10, 7, 0x8000, 0, 0, 0, 0}}));
    EXPECT_EQ(runs_at(*tiles, 16, 9), (std::vector<SplatRun>{{16, 9, 0, 0xFFFF, 0xFFFF, 0, 0x7FFF, 0x8000}}));
    EXPECT_TRUE(is_smooth_at(*tiles, 32, 10));  // nothing but its left neighbour is another object
    EXPECT_TRUE(is_smooth_at(*tiles, 16, 11));
    ASSERT_EQ(tiles->first_patch[1] - tiles->first_patch[0], 2);  // object 0 and object 7
    EXPECT_EQ(tiles->pixels_of_object[7].all, 1U);
}

TEST(SplatTiles, BadDepthsAreCountedAndLeftOutOfPatches) {
    CpuPixels pixels = flat_pixels();
    pixels.depth.at(20, 4) = std::numeric_limits<float>::quiet_NaN();
    pixels.depth.at(21, 4) = 7.0F;
    pixels.depth.at(22, 4) = -0.5F;
    const auto tiles = tiles_of(pixels);
    EXPECT_EQ(runs_at(*tiles, 16, 4), (std::vector<SplatRun>{{16, 4, 0, 0xFF8F, 0xFF87, 0x0008, 0xFF8F, 0}}));
    EXPECT_EQ(tiles->pixels_of_object[0].unusable, 3U);
    ASSERT_EQ(tiles->patches.size(), 2U);
    EXPECT_EQ(tiles->patches[0].least_depth, 0.1F);
    EXPECT_EQ(tiles->patches[0].greatest_depth, 0.1F);
}

TEST(SplatTiles, SkyIsEmptyAndAMoverAtInfinityIsNot) {
    CpuPixels pixels = flat_pixels();
    for (float& depth : pixels.depth.pixels()) depth = 0.0F;
    for (int x = 32; x < 48; ++x) pixels.object_id.at(x, 20) = 3;
    const auto tiles = tiles_of(pixels);
    EXPECT_TRUE(runs_at(*tiles, 16, 20).empty());
    EXPECT_EQ(tiles->background_in(0, 32, 20), BackgroundShare::all);
    EXPECT_EQ(tiles->background_in(0, 33, 20), BackgroundShare::some);
    EXPECT_EQ(tiles->background_in(32, 48, 20), BackgroundShare::none);
    EXPECT_EQ(runs_at(*tiles, 32, 20), (std::vector<SplatRun>{{32, 20, 3, 0xFFFF, 0, 0, 0, 0}}));  // of slope 0
    EXPECT_EQ(tiles->points[0], 0);
    EXPECT_EQ(tiles->points[1], 16);
}

// One pixel at a time, by the definition of splat_footprint.h, on depths and objects without any order; the image is no
// whole number of blocks wide.
TEST(SplatTiles, RunsHoldEveryPointOnceWithItsSlopes) {
    const glm::ivec2 size_px{77, 37};
    CpuPixels pixels{ColourImage{size_px}, DepthImage{size_px}, ObjectIdImage{size_px}};
    std::mt19937 random{7};
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            const float depth = 0.3F + 0.002F * static_cast<float>(random() % 8);
            pixels.depth.at(x, y) = random() % 16 != 0 ? depth : (random() % 2 != 0 ? 0.0F : 3.0F);
            pixels.object_id.at(x, y) = static_cast<ObjectId>(random() % 16 != 0 ? x / 20 : random() % 3);
        }
    }
    Image<int> held{size_px};
    const auto tiles = tiles_of(pixels);
    for (const SplatRun& run : tiles->runs) {
        for (int i = 0; i < kBlockWidth_px; ++i) {
            const auto has = [&](std::uint16_t mask) { return ((mask >> i) & 1) != 0; };
            if (!has(run.points)) continue;
            const glm::ivec2 at{run.x_px + i, run.y_px};
            ++held.at(at.x, at.y);
            EXPECT_EQ(run.object, pixels.object_id.at(at.x, at.y));
            const float depth = pixels.depth.at(at.x, at.y);
            const auto slope = [&](std::uint16_t after, std::uint16_t before, glm::ivec2 step) {
                if (has(after)) return pixels.depth.at(at.x + step.x, at.y + step.y) - depth;
                if (has(before)) return depth - pixels.depth.at(at.x - step.x, at.y - step.y);
                return 0.0F;
            };
            const DepthGradient expected = depth_gradient(pixels.depth, pixels.object_id, at.x, at.y);
            EXPECT_EQ(slope(run.after_x, run.before_x, {1, 0}), expected.x) << at.x << ", " << at.y;
            EXPECT_EQ(slope(run.after_y, run.before_y, {0, 1}), expected.y) << at.x << ", " << at.y;
        }
    }
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            const float depth = pixels.depth.at(x, y);
            const bool background = depth == 0.0F && pixels.object_id.at(x, y) == 0;
            EXPECT_EQ(held.at(x, y), depth <= 1.0F && !background ? 1 : 0) << x << ", " << y;
        }
    }
}

struct Built {
    std::shared_ptr<const SplatTiles> tiles;
    ObjectMatrices matrices;
    SplatReach reach;
    SplatPart part;  // the whole target
};

Built reach_of(const Layer& layer, const WarpTarget& target) {
    Built built;
    built.tiles = tiles_of(layer.cpu());
    built.matrices.build(layer, target);
    built.reach.build(*built.tiles, built.matrices, target.camera.size_px);
    built.part.build(built.reach, {{0, 0}, target.camera.size_px});
    return built;
}

// Every source pixel that lands in the picture lands, with its largest extent, in the rows its band was given, and its
// tile is not left out; and wholly inside the picture where its tile is said to land inside. Returns how many tiles
// are.
int expect_all_points_within(const Layer& layer, const WarpTarget& target) {
    const Built built = reach_of(layer, target);
    const CpuPixels& pixels = layer.cpu();
    const glm::ivec2 size_px = target.camera.size_px;
    for (int y = 0; y < pixels.depth.height(); ++y) {
        const RowRange rows = built.part.rows_of_band(y / kBandHeight_px);
        for (int x = 0; x < pixels.depth.width(); ++x) {
            const ObjectId id = pixels.object_id.at(x, y);
            if (id == 0 && pixels.depth.at(x, y) == 0.0F) continue;
            const auto* matrix = built.matrices.exact().find(id);
            if (matrix == nullptr) continue;
            const auto placed = reproject(*matrix, {x + 0.5, y + 0.5}, pixels.depth.at(x, y));
            if (!placed || placed->depth > 1.0) continue;
            const glm::dvec2 at = placed->position_px;
            const double extent = kLargestHalfExtentPx;
            const TileLanding landing =
                built.part.landings(y / kBandHeight_px)[static_cast<std::size_t>(x / kTileWidth_px)];
            if (landing == TileLanding::inside) {
                EXPECT_TRUE(at.x >= extent && at.x + extent <= size_px.x) << x << ", " << y;
                EXPECT_TRUE(at.y >= extent && at.y + extent <= size_px.y) << x << ", " << y;
            }
            if (at.x + extent < 0.0 || at.x - extent > size_px.x) continue;
            if (at.y + extent < 0.0 || at.y - extent > size_px.y) continue;
            EXPECT_LE(rows.begin, std::max(0.0, at.y - extent)) << x << ", " << y;
            EXPECT_GE(rows.end, std::min<double>(size_px.y, at.y + extent)) << x << ", " << y;
            EXPECT_NE(landing, TileLanding::outside);
            const PixelRect& rect = built.reach.rect_of(y / kBandHeight_px, x / kTileWidth_px);
            EXPECT_LE(rect.first_px.x, std::max(0.0, at.x - extent)) << x << ", " << y;
            EXPECT_GE(rect.end_px.x, std::min<double>(size_px.x, at.x + extent)) << x << ", " << y;
        }
    }
    int inside = 0;
    for (int band = 0; band < built.tiles->bands(); ++band) {
        inside += static_cast<int>(std::ranges::count(built.part.landings(band), TileLanding::inside));
    }
    return inside;
}

TEST(SplatReach, HoldsEveryPointAtAnyPose) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({200, 150});
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    int inside = 0;
    for (const glm::dvec3& turn_deg : {glm::dvec3{0.0}, {3.0, 1.0, 2.0}, {40.0, -20.0, 30.0}, {0.0, 0.0, 180.0}}) {
        for (const glm::dvec3& offset_m : {glm::dvec3{0.0}, {0.1, 0.05, -0.3}, {0.0, -1.2, -4.0}, {2.0, 8.0, 3.0}}) {
            SCOPED_TRACE(::testing::Message() << turn_deg.x << " degrees, " << offset_m.z << " m");
            inside +=
                expect_all_points_within(layer, {moved(source, offset_m, turn_deg.x, turn_deg.y, turn_deg.z), movers});
        }
    }
    EXPECT_GT(inside, 50);
}

std::vector<PixelRect> parts_of(const Layer& layer, const WarpTarget& target, int threads) {
    const Built built = reach_of(layer, target);
    SplatParts parts;
    parts.build(built.reach, *built.tiles, threads);
    return {parts.all().begin(), parts.all().end()};
}

TEST(SplatParts, OneThreadHasOneWhileTheHeadIsStillAndPanelsWhereRowsBend) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({1024, 1024});
    const Layer layer = scene.draw(source, 0.0);
    ASSERT_EQ(parts_of(layer, {source, scene.movers(0.0)}, 1).size(), 1U);

    const std::vector<ObjectTransform> movers = scene.movers(0.0);
    const WarpTarget turned{moved(source, {}, 30.0), movers};
    const std::vector<PixelRect> panels = parts_of(layer, turned, 1);
    ASSERT_GT(panels.size(), 1U);
    const Built whole = reach_of(layer, turned);
    for (const PixelRect& rect : panels) {
        SplatPart part;
        part.build(whole.reach, rect);
        EXPECT_EQ(rect.size_px().y, 1024);
        EXPECT_LT(part.rows_in_flight(), whole.part.rows_in_flight());
    }
}

TEST(SplatParts, CoverEveryPixelOnce) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({600, 121});
    const Layer layer = scene.draw(source, 0.0);
    for (const double roll_deg : {0.0, 90.0, 180.0}) {
        for (const int threads : {1, 2, 3, 16}) {
            SCOPED_TRACE(::testing::Message() << roll_deg << " degrees, " << threads << " threads");
            Image<int> parts{{600, 121}};
            for (const PixelRect& rect : parts_of(layer, {moved(source, {}, 5.0, 0.0, roll_deg), {}}, threads)) {
                for (int y = rect.first_px.y; y < rect.end_px.y; ++y) {
                    for (int x = rect.first_px.x; x < rect.end_px.x; ++x) ++parts.at(x, y);
                }
            }
            EXPECT_TRUE(std::ranges::all_of(parts.pixels(), [](int count) { return count == 1; }));
        }
    }
}

TEST(SplatParts, WhoTookLongerGetsLess) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({512, 512});
    const Layer layer = scene.draw(source, 0.0);
    const Built built = reach_of(layer, {source, scene.movers(0.0)});
    SplatParts parts;
    parts.build(built.reach, *built.tiles, 2);
    ASSERT_EQ(parts.all().size(), 2U);
    const int border = parts.all()[0].end_px.y;
    parts.learn(std::vector<double>{1.3, 0.7});
    parts.build(built.reach, *built.tiles, 2);
    ASSERT_EQ(parts.all().size(), 2U);
    EXPECT_LT(parts.all()[0].end_px.y, border);
}

TEST(SplatReach, FewRowsAreInFlightWhileTheHeadIsStill) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({512, 512});
    const Layer layer = scene.draw(source, 0.0);
    // A band of 16 rows with the margins of 3 px for extents and rounding above and below, and the row that they cut.
    EXPECT_LE(reach_of(layer, {source, scene.movers(0.0)}).part.rows_in_flight(), 16 + 2 * 4);
}

TEST(SplatReach, LeavesOutWhatTheHeadTurnedAwayFrom) {
    const AnalyticScene scene = AnalyticScene::wall(2.0);
    const Camera source = street_camera({256, 256});
    const Layer layer = scene.draw(source, 0.0);
    const int all = 4 * 16;
    EXPECT_EQ(reach_of(layer, {source, {}}).reach.tiles_outside(), 0);
    EXPECT_EQ(reach_of(layer, {moved(source, {}, 150.0), {}}).reach.tiles_outside(), all);
    const int turned = reach_of(layer, {moved(source, {}, 40.0), {}}).reach.tiles_outside();
    EXPECT_GE(turned, all / 4);  // what lay more than 5 degrees off to one side is gone: one column of tiles and more
    EXPECT_LT(turned, all);
}

}  // namespace
}  // namespace lw::test
