/// Several layers drawn into one picture.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/layer_composition.h"

namespace lw::test {
namespace {

Camera turned(Camera camera, double degrees) {
    camera.world_from_eye.orientation =
        glm::angleAxis(glm::radians(degrees), glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
    return camera;
}

// All of the street as static world.
Layer street(const Camera& camera) {
    Layer layer = AnalyticScene::street().draw(camera, 0.0);
    layer.movers = {};
    for (ObjectId& id : layer.cpu().object_id.pixels()) id = 0;
    layer.content = {0, 0, true, 1.0F, camera.near_m};
    return layer;
}

// What of a layer is as near as `depth`, or what is farther.
Layer part_by_depth(const Camera& camera, float depth, bool near) {
    Layer part = street(camera);
    part.content.item = near ? 0 : 1;
    part.content.shell = near ? 0 : 1;
    if (!near) {
        part.content.nearest_depth = depth;
        part.content.nearest_ray_m = part.camera.near_m / depth;
    }
    for (float& value : part.cpu().depth.pixels()) {
        if ((value >= depth) != near) {
            value = kNoSurfaceDepth;
            ++part.empty_pixels;
        }
    }
    return part;
}

Layer plane(const Camera& camera, float depth, std::uint32_t item, Rgba8 colour) {
    Layer layer = indexed_layer(camera, depth);
    for (Rgba8& value : layer.cpu().colour.pixels()) value = colour;
    layer.content = {item, 0, true, depth, camera.near_m / depth};
    return layer;
}

DisplayFrame shown(std::span<const Layer* const> layers, const Camera& target, bool stacked = true) {
    LayerComposition composition;
    DisplayFrame frame;
    // `splat` warps layer by layer.
    composition.show(*method_named(stacked ? "surface" : "splat"), layers, {target, {}}, frame);
    return frame;
}

constexpr Rgba8 kRed{255, 0, 0, 255};
constexpr Rgba8 kGreen{0, 255, 0, 255};
constexpr Rgba8 kBlue{0, 0, 255, 255};

TEST(LayerStack, TwoPartsOfAPictureShowWhatTheWholeShows) {
    const Camera source = street_camera({96, 96});
    const Layer whole = street(source);
    const auto cut = static_cast<float>(source.near_m / 6.0);
    const Layer near = part_by_depth(source, cut, true);
    const Layer far = part_by_depth(source, cut, false);
    const Layer* parts[] = {&near, &far};
    const Layer* alone[] = {&whole};
    for (const double degrees : {0.0, 3.0, 20.0}) {
        const Camera target = turned(source, degrees);
        const DisplayFrame expected = shown(alone, target);
        const DisplayFrame actual = shown(parts, target);
        int differ = 0;
        int holes = 0;
        for (std::size_t i = 0; i < expected.colour.pixels().size(); ++i) {
            if (expected.coverage.pixels()[i] != Coverage::reached) continue;
            holes += actual.coverage.pixels()[i] != Coverage::reached ? 1 : 0;
            const Rgba8 a = actual.colour.pixels()[i];
            const Rgba8 b = expected.colour.pixels()[i];
            differ += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 24 ? 1 : 0;
        }
        // Along the cut the whole has a surface where the parts have two edges, which together cover most of a pixel.
        EXPECT_LT(holes, 50) << degrees << " degrees";
        EXPECT_LT(differ, 96 * 96 / 25) << degrees << " degrees";
    }
}

TEST(LayerStack, CountsWhatIsBadButNotWhatIsEmpty) {
    const Camera source = street_camera({32, 32});
    const auto cut = static_cast<float>(source.near_m / 6.0);
    const Layer near = part_by_depth(source, cut, true);
    Layer far = part_by_depth(source, cut, false);
    far.cpu().depth.at(4, 4) = std::numeric_limits<float>::quiet_NaN();
    const bool was_empty = near.cpu().depth.at(4, 4) != kNoSurfaceDepth;
    const Layer* parts[] = {&near, &far};
    LayerComposition composition;
    DisplayFrame frame;
    const WarpCounters counters = composition.show(*method_named("surface"), parts, {turned(source, 5.0), {}}, frame);
    EXPECT_EQ(counters.bad_depth, was_empty ? 0U : 1U);
}

TEST(LayerStack, NothingOfAnotherLayerShinesThroughBetweenTheSurfacesOfOne) {
    // Two walls of one layer side by side at different depths, and green far behind both.
    const Camera source = street_camera({32, 32});
    Layer walls = plane(source, 0.05F, 0, kRed);
    for (int y = 0; y < 32; ++y) {
        for (int x = 16; x < 32; ++x) walls.cpu().depth.at(x, y) = 0.02F;
    }
    Layer far = plane(source, 0.001F, 1, kGreen);
    far.content.shell = 1;
    const Layer* layers[] = {&walls, &far};
    const DisplayFrame frame = shown(layers, turned(source, 0.7));
    for (int y = 4; y < 28; ++y) {
        for (int x = 4; x < 28; ++x) EXPECT_EQ(frame.colour.at(x, y).g, 0) << x << ", " << y;
    }
}

TEST(LayerStack, OfTwoPicturesOfOneSurfaceTheFirstIsSeen) {
    const Camera camera = street_camera({32, 32});
    const Layer view = plane(camera, 0.05F, 0, kRed);
    Layer slightly_nearer = plane(camera, 0.0501F, 1, kGreen);
    slightly_nearer.content.shell = 1;
    const Layer* layers[] = {&view, &slightly_nearer};
    const DisplayFrame frame = shown(layers, turned(camera, 2.0));
    for (int y = 2; y < 30; ++y) EXPECT_EQ(frame.colour.at(16, y), kRed);
}

TEST(LayerStack, AViewThatDoesNotMoveStaysBitForBit) {
    const Camera camera = street_camera({32, 32});
    Layer view = indexed_layer(camera, 0.05F);
    view.content = {0, 0, true, 0.05F, 1.0};
    view.cpu().depth.at(7, 9) = kNoSurfaceDepth;
    view.empty_pixels = 1;
    Layer far = plane(camera, 0.01F, 1, kGreen);
    far.content.shell = 1;
    const Layer* layers[] = {&view, &far};
    const DisplayFrame frame = shown(layers, camera);
    EXPECT_EQ(frame.colour.at(7, 9), kGreen);
    for (int x = 0; x < 32; ++x) EXPECT_EQ(frame.colour.at(x, 3), view.cpu().colour.at(x, 3));
}

TEST(LayerStack, TilesBesideTheViewShowWhereItDoesNotLook) {
    const Camera camera = street_camera({64, 64});
    const Layer view = plane(camera, 0.03F, 0, kRed);
    Layer tile = plane(turned(camera, -60.0), 0.05F, 7, kGreen);
    const Layer* layers[] = {&view, &tile};
    const DisplayFrame frame = shown(layers, turned(camera, -40.0));
    EXPECT_EQ(frame.colour.at(4, 32), kRed);
    EXPECT_EQ(frame.colour.at(56, 32), kGreen);
    for (const float depth : frame.depth.pixels()) EXPECT_LE(depth, 1.0F) << "a depth that held a pixel was left";
}

TEST(LayerStack, TilesBesideTheViewLeaveItsOlderSideAlone) {
    const Camera camera = street_camera({64, 64});
    Camera left = camera;
    left.size_px.x = 34;
    left.fov.right = camera.fov.left + (camera.fov.right - camera.fov.left) * 34 / 64;
    Camera right = turned(camera, 1.0);
    right.size_px.x = 34;
    right.fov.left = camera.fov.right - (camera.fov.right - camera.fov.left) * 34 / 64;
    const Layer newest = plane(left, 0.03F, 0, kRed);
    const Layer older = plane(right, 0.03F, 0, kBlue);
    const Layer tile = plane(camera, 0.05F, 7, kGreen);
    const Layer* layers[] = {&newest, &older, &tile};
    for (const bool stacked : {true, false}) {
        const DisplayFrame frame = shown(layers, camera, stacked);
        EXPECT_EQ(frame.colour.at(6, 32), kRed);
        EXPECT_EQ(frame.colour.at(58, 32), kBlue) << "no green before it, though that is nearer";
    }
}

TEST(LayerStack, ATileBesideTheViewDoesNotReplaceWhatTheViewShows) {
    const Camera camera = street_camera({64, 64});
    Layer view = plane(camera, 0.03F, 0, kRed);
    // What only the tile has: enough of it that the tile is worth drawing.
    for (int y = 20; y < 44; ++y) {
        for (int x = 20; x < 44; ++x) view.cpu().depth.at(x, y) = kNoSurfaceDepth;
    }
    const Layer tile = plane(camera, 0.05F, 7, kGreen);
    const Layer* layers[] = {&view, &tile};
    const DisplayFrame frame = shown(layers, turned(camera, 1.0));
    EXPECT_EQ(frame.colour.at(6, 6), kRed);
    EXPECT_EQ(frame.colour.at(32, 32), kGreen);
}

TEST(LayerStack, SurfacesBehindTheEyeAreNotCut) {
    const Camera camera = street_camera({64, 64});
    const Layer behind = street(turned(camera, 180.0));
    const auto method = method_named("surface");
    DisplayFrame frame;
    method->warp(behind, {camera, {}}, frame);
    EXPECT_EQ(std::count(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::reached), 0);
    EXPECT_GT(method->counters().tiles_outside, 0U);
    EXPECT_LT(method->counters().tiles_outside, 2000U) << "cut to cells they were more";
}

}  // namespace
}  // namespace lw::test
