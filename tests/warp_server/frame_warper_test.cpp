#include "warp_server/frame_warper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

using SharedLayer = std::shared_ptr<const Layer>;

SharedLayer shared(Layer layer) { return std::make_shared<const Layer>(std::move(layer)); }

RenderedFrame frame_with(std::vector<SharedLayer> layers) {
    RenderedFrame frame;
    frame.layers = std::move(layers);
    return frame;
}

TEST(FrameWarper, ReportsWhatIsWrongWithItsParts) {
    EXPECT_FALSE(FrameWarper::create("magic", "none").ok());
    EXPECT_FALSE(FrameWarper::create("splat", "magic").ok());
    EXPECT_TRUE(FrameWarper::create("splat", "nearest-background").ok());
}

TEST(FrameWarper, LeavesNoHoleAndCountsThem) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({96, 96});
    auto warper = FrameWarper::create("splat", "nearest-background");
    ASSERT_TRUE(warper.ok());
    Layer layer = scene.draw(source, 0.0);
    warper->prepare(layer);
    const RenderedFrame frame = frame_with({shared(std::move(layer))});
    const DisplayFrame& shown = warper->warp(frame, {moved(source, {0.1, 0.0, 0.0}, 5.0), {}});
    EXPECT_THAT(shown.coverage.pixels(), ::testing::Not(::testing::Contains(Coverage::hole)));
    EXPECT_GT(warper->hole_fraction(), 0.01);
    EXPECT_LT(warper->hole_fraction(), 0.5);
}

TEST(FrameWarper, OfSeveralLayersTheNearestSurfaceIsSeen) {
    const Camera camera = street_camera({8, 4});
    Layer back = indexed_layer(camera, 0.01F);
    Layer front = indexed_layer(camera, 0.05F);
    for (Rgba8& colour : front.cpu().colour.pixels()) colour = {255, 0, 0, 255};
    for (int y = 0; y < 4; ++y) {
        for (int x = 4; x < 8; ++x) front.cpu().depth.at(x, y) = 0.0F;  // sky: the back layer is nearer there
    }
    const Rgba8 back_colour = back.cpu().colour.at(6, 1);
    const SharedLayer shared_back = shared(std::move(back));
    const SharedLayer shared_front = shared(std::move(front));
    for (const bool front_first : {true, false}) {
        auto warper = FrameWarper::create("splat", "none");
        const RenderedFrame frame =
            front_first ? frame_with({shared_front, shared_back}) : frame_with({shared_back, shared_front});
        const DisplayFrame& shown = warper->warp(frame, {camera, {}});
        EXPECT_EQ(shown.colour.at(1, 1), (Rgba8{255, 0, 0, 255}));
        EXPECT_EQ(shown.colour.at(6, 1), back_colour);
    }
}

TEST(FrameWarper, ShowsThePictureAgainOnlyWhenNothingChanged) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({48, 48});
    const Camera target = moved(source, {0.05, 0.0, 0.0}, 2.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    const std::vector<ObjectTransform> later = scene.movers(0.2);
    const RenderedFrame frame = frame_with({shared(scene.draw(source, 0.0))});
    const RenderedFrame newer = frame_with({shared(scene.draw(source, 0.05))});
    for (const char* method : {"surface", "splat", "rotation"}) {
        auto warper = FrameWarper::create(method, "nearest-background");
        const auto reused_for = [&](const RenderedFrame& shown, const WarpTarget& where) {
            const ColourImage picture = warper->warp(shown, where).colour;
            auto fresh = FrameWarper::create(method, "nearest-background");
            EXPECT_EQ(picture, fresh->warp(shown, where).colour) << method;
            return warper->counters().pictures_reused != 0;
        };
        EXPECT_FALSE(reused_for(frame, {target, movers}));
        EXPECT_TRUE(reused_for(frame, {target, movers}));
        EXPECT_TRUE(reused_for(frame, {target, movers}));
        EXPECT_FALSE(reused_for(frame, {target, later}));
        EXPECT_FALSE(reused_for(frame, {moved(target, {0.0, 0.0, 0.0}, 0.1), later}));
        EXPECT_FALSE(reused_for(newer, {moved(target, {0.0, 0.0, 0.0}, 0.1), later}));
        EXPECT_TRUE(reused_for(newer, {moved(target, {0.0, 0.0, 0.0}, 0.1), later}));
    }
}

TEST(FrameWarper, ALayerAtTheAddressOfAnOldOneIsAnotherLayer) {
    const Camera camera = street_camera({8, 4});
    auto warper = FrameWarper::create("splat", "none");
    for (int i = 0; i < 8; ++i) {  // allocators like to give freed memory out again
        Layer layer = indexed_layer(camera, 0.01F);
        const auto red = static_cast<std::uint8_t>(i);
        for (Rgba8& colour : layer.cpu().colour.pixels()) colour = {red, 0, 0, 255};
        const RenderedFrame frame = frame_with({shared(std::move(layer))});
        EXPECT_EQ(warper->warp(frame, {camera, {}}).colour.at(1, 1).r, red);
    }
}

TEST(FrameWarper, PixelsThatHoldNothingAreHolesAndNotBad) {
    const Camera camera = street_camera({8, 4});
    Layer layer = indexed_layer(camera, 0.05F);
    for (int y = 0; y < 4; ++y) layer.cpu().depth.at(5, y) = kNoSurfaceDepth;
    layer.cpu().depth.at(2, 2) = 7.0F;
    layer.empty_pixels = 4;
    const SharedLayer front = shared(std::move(layer));
    for (const char* method : {"stale", "rotation", "splat", "inverse", "surface", "reference"}) {
        auto warper = FrameWarper::create(method, "none");
        const DisplayFrame& shown = warper->warp(frame_with({front}), {camera, {}});
        EXPECT_NE(shown.coverage.at(5, 1), Coverage::reached) << method;
        EXPECT_EQ(shown.coverage.at(4, 1), Coverage::reached) << method;
        EXPECT_EQ(warper->counters().bad_depth, 1U) << method;
        // What lies behind shows there, and nowhere else.
        const SharedLayer back = shared(indexed_layer(camera, 0.01F));
        const DisplayFrame& both = warper->warp(frame_with({front, back}), {camera, {}});
        EXPECT_EQ(both.coverage.at(5, 1), Coverage::reached) << method;
        // Where layers are drawn into one picture, those behind the first count as a part of a percent farther.
        EXPECT_NEAR(both.depth.at(5, 1), 0.01F, 0.01F * 0.003F) << method;
        EXPECT_NEAR(both.depth.at(4, 1), 0.05F, 1e-6F) << method;
    }
}

TEST(FrameWarper, StaleTurnsWhatWasDrawnEarlierToTheFramesView) {
    const Camera camera = street_camera({64, 64});
    Layer view = indexed_layer(camera, 0.05F);
    for (float& depth : view.cpu().depth.pixels()) depth = kNoSurfaceDepth;
    view.empty_pixels = 64 * 64;
    // A picture of the same place, drawn when the head looked 10 degrees aside: half of it is red.
    Layer older = indexed_layer(moved(camera, {}, 10.0), 0.01F);
    older.content.shell = 1;
    older.content.item = 1;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x)
            older.cpu().colour.at(x, y) = {static_cast<std::uint8_t>(x < 32 ? 255 : 0), 0, 0, 255};
    }
    auto warper = FrameWarper::create("stale", "none");
    auto turning = FrameWarper::create("rotation", "none");
    const SharedLayer red_half = shared(std::move(older));
    const RenderedFrame frame = frame_with({shared(std::move(view)), red_half});
    const DisplayFrame& shown = warper->warp(frame, {moved(camera, {}, 25.0), {}});
    const DisplayFrame& expected = turning->warp(frame_with({red_half}), {camera, {}});
    int differ = 0;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            if (expected.coverage.at(x, y) != Coverage::reached) continue;
            differ += shown.colour.at(x, y) == expected.colour.at(x, y) ? 0 : 1;
        }
    }
    EXPECT_EQ(differ, 0) << "of the pixels that the older picture reaches";
    EXPECT_GT(hole_fraction(expected), 0.0) << "it must not reach all of them, or nothing was turned";
    EXPECT_LT(hole_fraction(expected), 0.5);
}

}  // namespace
}  // namespace lw::test
