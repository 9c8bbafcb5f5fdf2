#include "warp_server/layer_composition.h"

#include <gtest/gtest.h>

#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/hole_attribution.h"

namespace lw::test {
namespace {

Camera turned(Camera camera, double degrees) {
    camera.world_from_eye.orientation =
        glm::angleAxis(glm::radians(degrees), glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
    return camera;
}

Layer static_layer(const Camera& camera, float depth) {
    Layer layer = indexed_layer(camera, depth);
    layer.content.static_only = true;
    layer.content.nearest_depth = depth;
    layer.content.nearest_ray_m = camera.near_m / depth;
    return layer;
}

TEST(LayerReach, ALayerReachesAllOfItsOwnView) {
    const Camera camera = street_camera({32, 32});
    const PixelRect rect = reach_of(static_layer(camera, 0.01F), camera);
    EXPECT_EQ(rect.first_px, glm::ivec2(0, 0));
    EXPECT_EQ(rect.end_px, glm::ivec2(32, 32));
}

TEST(LayerReach, NothingBehindTheHeadIsReached) {
    const Camera camera = street_camera({32, 32});
    EXPECT_TRUE(reach_of(static_layer(camera, 0.01F), turned(camera, 180.0)).empty());
    Layer with_movers = static_layer(camera, 0.01F);
    with_movers.content.static_only = false;
    EXPECT_FALSE(reach_of(with_movers, turned(camera, 180.0)).empty()) << "a mover may have gone anywhere";
}

TEST(LayerReach, HoldsEveryPixelThatAWarpReaches) {
    const Camera source = street_camera({48, 48});
    for (const double degrees : {-70.0, -30.0, 10.0, 60.0, 95.0}) {
        for (const double step_m : {0.0, 0.3, -1.0}) {
            Camera target = turned(source, degrees);
            target.world_from_eye.position_m += glm::dvec3{step_m, 0.1, 0.5 * step_m};
            const Layer layer = static_layer(source, 0.02F);
            const PixelRect rect = reach_of(layer, target);
            const DisplayFrame shown = warp_once("splat", layer, {target, {}});
            for (int y = 0; y < 48; ++y) {
                for (int x = 0; x < 48; ++x) {
                    if (shown.coverage.at(x, y) != Coverage::reached) continue;
                    const bool inside =
                        x >= rect.first_px.x && x < rect.end_px.x && y >= rect.first_px.y && y < rect.end_px.y;
                    EXPECT_TRUE(inside) << x << ", " << y << " at " << degrees << " degrees, " << step_m << " m";
                }
            }
        }
    }
}

TEST(LayerComposition, ACroppedWarpShowsWhatAWholeOneShows) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({64, 64});
    Camera target = turned(source, 50.0);
    Layer layer = scene.draw(source, 0.0);
    layer.movers = {};
    for (ObjectId& id : layer.cpu().object_id.pixels()) id = 0;
    const DisplayFrame whole = warp_once("surface", layer, {target, {}});
    layer.content = {0, 0, true, 0.05F, 1.0};
    DisplayFrame shown;
    shown.resize(target.size_px);
    std::fill(shown.coverage.pixels().begin(), shown.coverage.pixels().end(), Coverage::hole);
    LayerComposition composition;
    const auto method = method_named("surface");
    EXPECT_LT(reach_of(layer, target).size_px().x, 50) << "half of it is out of view";
    EXPECT_TRUE(composition.add(*method, layer, layer, {target, {}}, shown));
    int differ = 0;
    for (std::size_t i = 0; i < whole.coverage.pixels().size(); ++i) {
        const bool same =
            whole.coverage.pixels()[i] == shown.coverage.pixels()[i] &&
            (whole.coverage.pixels()[i] != Coverage::reached || whole.colour.pixels()[i] == shown.colour.pixels()[i]);
        differ += same ? 0 : 1;
    }
    EXPECT_LT(differ, 20) << "matrices of a part are rounded to float elsewhere: a few pixels by a step";
}

TEST(LayerComposition, WhatIsWhollyBehindIsNotWarped) {
    const Camera camera = street_camera({16, 16});
    const Layer view = static_layer(camera, 0.05F);
    LayerComposition composition;
    const auto method = method_named("splat");
    DisplayFrame shown = warp_once("splat", static_layer(camera, 0.05F), {camera, {}});
    const DisplayFrame before = shown;
    EXPECT_FALSE(composition.add(*method, static_layer(camera, 0.01F), view, {camera, {}}, shown));
    EXPECT_EQ(shown.colour, before.colour);
    shown.coverage.at(3, 5) = Coverage::hole;
    EXPECT_TRUE(composition.add(*method, static_layer(camera, 0.01F), view, {camera, {}}, shown));
    EXPECT_EQ(shown.coverage.at(3, 5), Coverage::reached);
    EXPECT_FLOAT_EQ(shown.depth.at(3, 5), 0.01F);
    EXPECT_FLOAT_EQ(shown.depth.at(4, 5), 0.05F);
}

TEST(LayerComposition, OfTwoPicturesOfOneSurfaceTheFirstStays) {
    const Camera camera = street_camera({16, 16});
    LayerComposition composition;
    const auto method = method_named("splat");
    DisplayFrame shown = warp_once("splat", static_layer(camera, 0.05F), {camera, {}});
    const DisplayFrame before = shown;
    Layer slightly_nearer = static_layer(camera, 0.05F * 1.001F);
    for (Rgba8& colour : slightly_nearer.cpu().colour.pixels()) colour = {255, 0, 0, 255};
    composition.add(*method, slightly_nearer, slightly_nearer, {camera, {}}, shown);
    EXPECT_EQ(shown.colour, before.colour);
}

TEST(LayerComposition, OlderTilesOfTheNearestShellFillOnlyHolesWhereTheViewLooks) {
    const Camera camera = street_camera({16, 16});
    const Layer view = static_layer(camera, 0.01F);
    Layer tile = static_layer(camera, 0.05F);
    tile.content.item = 7;
    LayerComposition composition;
    const auto method = method_named("splat");
    DisplayFrame shown = warp_once("splat", view, {camera, {}});
    EXPECT_FALSE(composition.add(*method, tile, view, {camera, {}}, shown)) << "the view says that nothing is there";
    // Half of the target lies past the view's edge.
    const Camera target = turned(camera, 45.0);
    shown = warp_once("splat", view, {target, {}});
    EXPECT_TRUE(composition.add(*method, tile, view, {target, {}}, shown));
}

TEST(HoleAttribution, CountsForTheLayersThatLookThere) {
    const Camera camera = street_camera({32, 32});
    auto ahead = std::make_shared<Layer>(static_layer(camera, 0.01F));
    auto behind = std::make_shared<Layer>(static_layer(turned(camera, 180.0), 0.01F));
    ahead->content.item = 3;
    behind->content.item = 5;
    RenderedFrame frame;
    frame.layers = {ahead, behind};
    DisplayFrame shown = warp_once("splat", *ahead, {camera, {}});
    HoleFeedback feedback;
    attribute_holes(shown, frame, camera, feedback);
    EXPECT_TRUE(feedback.holes_px.empty());
    for (int y = 8; y < 16; ++y) {
        for (int x = 8; x < 16; ++x) shown.coverage.at(x, y) = Coverage::filled;
    }
    attribute_holes(shown, frame, camera, feedback);
    EXPECT_EQ(feedback.display_frames, 2U);
    ASSERT_EQ(feedback.holes_px.size(), 4U);
    EXPECT_EQ(feedback.holes_px[3], 64U);
}

}  // namespace
}  // namespace lw::test
