/// The ladder that every CPU warp method climbs: identity, analytic places, movers, occlusion, bad pixels, sizes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/reprojection.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/fill.h"

namespace lw::test {
namespace {

std::string test_name_of(const ::testing::TestParamInfo<std::string>& info) {
    std::string name = info.param;
    for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    }
    return name;
}

/// Every method that runs without GL.
class CpuMethod : public ::testing::TestWithParam<std::string> {};

/// Those that move pixels by their depth.
class DepthMethod : public ::testing::TestWithParam<std::string> {};

/// Those that show each source pixel's colour unmixed, so that an index in the colour survives.
class PointMethod : public ::testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(All, CpuMethod,
                         ::testing::Values("stale", "rotation", "splat", "inverse", "surface", "reference"),
                         test_name_of);
INSTANTIATE_TEST_SUITE_P(All, DepthMethod, ::testing::Values("splat", "surface", "reference"), test_name_of);
INSTANTIATE_TEST_SUITE_P(All, PointMethod, ::testing::Values("splat", "reference"), test_name_of);

// Identity.

TEST_P(CpuMethod, ZeroMotionReturnsTheSourceBitForBit) {
    const AnalyticScene scene = AnalyticScene::street();
    Camera camera = moved(street_camera({96, 64}), {0.3, 0.1, -0.2}, 12.0, -5.0, 2.0);
    camera.fov = {-1.1, 0.9, -0.6, 0.7};
    const Layer layer = scene.draw(camera, 0.25);
    const DisplayFrame frame = warp_once(GetParam(), layer, {camera, layer.movers});
    EXPECT_TRUE(shows_source_exactly("identity-" + GetParam(), frame, layer.cpu()));
}

TEST_P(CpuMethod, ZeroMotionHoldsForEverySize) {
    for (const glm::ivec2& size_px : {glm::ivec2{1, 1}, glm::ivec2{3, 5}, glm::ivec2{17, 2}, glm::ivec2{8192, 16}}) {
        Camera camera = street_camera(size_px);
        camera.world_from_eye.position_m = {1e7, 2.0, -3e6};  // an astronomical origin must not shake a still picture
        const Layer layer = noise_layer(camera);
        const DisplayFrame frame = warp_once(GetParam(), layer, {camera, {}});
        EXPECT_TRUE(shows_source_exactly("sizes-" + GetParam(), frame, layer.cpu())) << size_px.x << "x" << size_px.y;
    }
}

TEST_P(CpuMethod, AMethodCanBeUsedAgainWithOtherSizes) {
    const auto method = method_named(GetParam());
    DisplayFrame frame;
    for (const glm::ivec2& size_px : {glm::ivec2{40, 30}, glm::ivec2{8, 8}, glm::ivec2{64, 16}}) {
        const Camera camera = street_camera(size_px);
        const Layer layer = noise_layer(camera);
        method->warp(layer, {camera, {}}, frame);
        EXPECT_TRUE(shows_source_exactly("again-" + GetParam(), frame, layer.cpu()));
    }
}

// Analytic places.

TEST(RotationMethod, TurnsASmoothSkyLikeTheHomography) {
    // Sky only: smooth, so that bilinear resampling stays within 2 steps of the truth (0.3 levels per px here, plus
    // rounding of source and result).
    const AnalyticScene scene;
    const Camera source = street_camera({128, 96});
    const Camera target = moved(source, {0.0, 0.0, 0.0}, 4.0, 2.0, 3.0);
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame frame = warp_once("rotation", layer, {target, {}});
    const ColourImage truth = scene.truth(target, 0.0, 1);
    std::size_t reached = 0;
    for (std::size_t i = 0; i < truth.pixels().size(); ++i) {
        if (frame.coverage.pixels()[i] != Coverage::reached) continue;
        ++reached;
        EXPECT_NEAR(frame.colour.pixels()[i].r, truth.pixels()[i].r, 2) << i;
    }
    EXPECT_GT(reached, truth.pixels().size() * 8 / 10);
}

// Where the shown source pixel belongs, by the double-precision kernel; compared with the pixel that shows it.
struct PlaceError {
    double largest_px = 0.0;  // along x or y
    std::size_t reached = 0;
};

PlaceError place_error(const Layer& layer, const Camera& target, const DisplayFrame& frame) {
    const auto target_px_from_source_px = static_target_px_from_source_px(layer.camera, target);
    PlaceError error;
    for (int y = 0; y < frame.colour.height(); ++y) {
        for (int x = 0; x < frame.colour.width(); ++x) {
            if (frame.coverage.at(x, y) != Coverage::reached) continue;
            const std::uint32_t index = index_of_colour(frame.colour.at(x, y));
            const auto width = static_cast<std::uint32_t>(layer.camera.size_px.x);
            const glm::dvec2 source_px{index % width + 0.5, index / width + 0.5};
            const auto placed = reproject(target_px_from_source_px, source_px, layer.cpu().depth.pixels()[index]);
            if (!placed) {
                ADD_FAILURE() << "pixel " << x << ", " << y << " shows a source pixel from behind the eye";
                continue;
            }
            const glm::dvec2 offset = glm::abs(placed->position_px - glm::dvec2{x + 0.5, y + 0.5});
            error.largest_px = std::max({error.largest_px, offset.x, offset.y});
            ++error.reached;
        }
    }
    return error;
}

TEST_P(PointMethod, ARotationEqualsTheHomography) {
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.0, 0.0, 0.0}, 5.0, -3.0, 0.0);
    const Layer layer = indexed_layer(source, 0.02F);
    const DisplayFrame frame = warp_once(GetParam(), layer, {target, {}});
    const PlaceError error = place_error(layer, target, frame);
    EXPECT_GT(error.reached, 160U * 120U * 8U / 10U);
    // Half a pixel, times the largest row sum of the Jacobian in a corner of 106 x 90 degrees turned by 5.8 degrees.
    EXPECT_LE(error.largest_px, 0.5 * 1.33);
}

TEST_P(PointMethod, ATexturedPlaneLandsWithinHalfAPixel) {
    const AnalyticScene scene = AnalyticScene::wall(2.0, 0.3);
    const Camera source = street_camera({160, 120});
    // Backwards: nothing is magnified, so half a pixel is the whole of the footprint.
    const Camera target = moved(source, {0.05, -0.03, 0.4}, 0.0);
    Layer layer = scene.draw(source, 0.0);
    colour_by_index(layer);
    const DisplayFrame frame = warp_once(GetParam(), layer, {target, {}});
    const PlaceError error = place_error(layer, target, frame);
    EXPECT_GT(error.reached, 160U * 120U * 6U / 10U);
    EXPECT_LE(error.largest_px, 0.5 + 1e-3);  // float rounding of a coordinate of 160 px: 2e-5
}

TEST_P(PointMethod, MagnificationLeavesNoCracks) {
    const AnalyticScene scene = AnalyticScene::wall(2.0, 0.4);
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.0, 0.0, -0.6}, 3.0);
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame frame = warp_once(GetParam(), layer, {target, {}});
    EXPECT_EQ(std::count(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::hole), 0);
}

TEST_P(DepthMethod, DepthOfAPlaneIsThatOfTheTarget) {
    const AnalyticScene scene = AnalyticScene::wall(3.0, 0.3);
    const Camera source = street_camera({96, 96});
    const Camera target = moved(source, {0.1, 0.05, -0.2}, 2.0, 1.0);
    const DisplayFrame frame = warp_once(GetParam(), scene.draw(source, 0.0), {target, {}});
    const DepthImage truth = scene.truth_depth(target, 0.0);
    for (std::size_t i = 0; i < truth.pixels().size(); ++i) {
        if (frame.coverage.pixels()[i] != Coverage::reached) continue;
        // A place off by up to 0.6 px on a plane whose depth changes by 0.7 % per pixel at most.
        ASSERT_NEAR(frame.depth.pixels()[i], truth.pixels()[i], 0.006 * truth.pixels()[i]) << i;
    }
}

// Movers and occlusion.

// Not on a silhouette, where half a pixel decides.
bool inside_solid(const Image<int>& solid, std::size_t index) {
    const int width = solid.width();
    const int x = static_cast<int>(index) % width;
    const int y = static_cast<int>(index) / width;
    if (x == 0 || y == 0 || x + 1 == width || y + 1 == solid.height()) return false;
    const int own = solid.at(x, y);
    return solid.at(x - 1, y) == own && solid.at(x + 1, y) == own && solid.at(x, y - 1) == own &&
           solid.at(x, y + 1) == own;
}

TEST_P(DepthMethod, MoversLandWhereTheirOwnTransformsLead) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({192, 192});
    const Camera target = moved(source, {0.02, 0.0, -0.03}, 1.0);
    const double age_s = 0.03;  // the spinning box turns by 11 degrees, the sliding one moves 6 cm
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(age_s);
    const DisplayFrame frame = warp_once(GetParam(), layer, {target, movers});
    const DepthImage truth_depth = scene.truth_depth(target, age_s);
    const Image<int> solid = scene.solid_at(target, age_s);
    const Image<std::uint8_t> seen = scene.seen_by_source(target, age_s, source, 0.0);
    std::size_t on_movers = 0;
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < solid.pixels().size(); ++i) {
        if (seen.pixels()[i] == 0 || solid.pixels()[i] < 0) continue;
        if (scene.solids[static_cast<std::size_t>(solid.pixels()[i])].id == 0) continue;
        if (!inside_solid(solid, i)) continue;
        ++on_movers;
        const bool right =
            frame.coverage.pixels()[i] == Coverage::reached &&
            std::abs(frame.depth.pixels()[i] - truth_depth.pixels()[i]) < 0.02F * truth_depth.pixels()[i];
        if (!right) ++wrong;
    }
    EXPECT_GT(on_movers, 500U);
    // The face that turns into view was seen at a grazing angle, where a pixel's own slope can hardly be told from
    // an edge: three columns of cracks, 15 px high, of 680 px.
    EXPECT_LT(static_cast<double>(wrong), 0.08 * static_cast<double>(on_movers));
}

TEST_P(DepthMethod, AMoverWithoutATargetPlacementHoldsItsSourcePlacement) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera camera = street_camera({64, 64});
    const Layer layer = scene.draw(camera, 0.0);
    const DisplayFrame frame = warp_once(GetParam(), layer, {camera, {}});
    EXPECT_TRUE(shows_source_exactly("held-" + GetParam(), frame, layer.cpu()));
}

TEST_P(DepthMethod, TheNearerSurfaceWinsInEveryOrderOfPixels) {
    // A near strip over a far wall, pushed to either side across it: writes come in both orders.
    for (const double offset_m : {-0.4, 0.4}) {
        Camera source = street_camera({64, 32});
        Layer layer = indexed_layer(source, 0.01F);
        for (int y = 0; y < 32; ++y) {
            for (int x = 24; x < 40; ++x) {
                layer.cpu().depth.at(x, y) = 0.05F;
                layer.cpu().colour.at(x, y) = {255, 0, 0, 255};
            }
        }
        const Camera target = moved(source, {offset_m, 0.0, 0.0}, 0.0);
        const DisplayFrame frame = warp_once(GetParam(), layer, {target, {}});
        // 1 m away, 16 px per metre per unit of tangent: the strip moves by 6.4 px against the wall's 1.3 px.
        const int shift_px = static_cast<int>(std::lround(-offset_m * 16.0));
        for (int x = 26 + shift_px; x < 38 + shift_px; ++x) {
            EXPECT_EQ(frame.colour.at(x, 16), (Rgba8{255, 0, 0, 255})) << x << " offset " << offset_m;
        }
    }
}

TEST_P(DepthMethod, TheBackgroundTurnsAndNeverMoves) {
    const AnalyticScene sky;
    const Camera camera = street_camera({48, 48});
    const Layer layer = sky.draw(camera, 0.0);
    const DisplayFrame frame = warp_once(GetParam(), layer, {moved(camera, {3.0, 1.0, -5.0}, 0.0), {}});
    EXPECT_TRUE(images_agree("sky-" + GetParam(), frame.colour, layer.cpu().colour, 0));
    EXPECT_THAT(frame.depth.pixels(), ::testing::Each(0.0F));
}

// What must be skipped.

TEST_P(DepthMethod, SamplesNearerThanTheNearPlaneAreSkipped) {
    const Camera source = street_camera({32, 32});
    const Layer layer = indexed_layer(source, 0.05F);                  // a wall 1 m away
    const Camera short_of_it = moved(source, {0.0, 0.0, -0.94}, 0.0);  // 6 cm before it, near is 5 cm
    const Camera too_near = moved(source, {0.0, 0.0, -0.96}, 0.0);     // 4 cm before it
    const Camera beyond = moved(source, {0.0, 0.0, -1.5}, 0.0);        // the wall is behind the eye
    const auto reached = [&](const Camera& camera) {
        const DisplayFrame frame = warp_once(GetParam(), layer, {camera, {}});
        return std::count(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::reached);
    };
    EXPECT_GT(reached(short_of_it), 0);
    EXPECT_EQ(reached(too_near), 0);
    EXPECT_EQ(reached(beyond), 0);
}

TEST_P(DepthMethod, BadPixelsAreCountedAndSkipped) {
    const Camera camera = street_camera({16, 16});
    Layer layer = indexed_layer(camera, 0.05F);
    layer.movers = {{3, glm::dmat4{1.0}}, {5, glm::dmat4{0.0}}};  // 5 has no inverse: no usable placement
    layer.cpu().depth.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
    layer.cpu().depth.at(2, 1) = std::numeric_limits<float>::infinity();
    layer.cpu().depth.at(3, 1) = -0.01F;
    layer.cpu().depth.at(4, 1) = 1.01F;
    layer.cpu().object_id.at(5, 1) = 4;
    layer.cpu().object_id.at(6, 1) = 5;
    layer.cpu().object_id.at(7, 1) = 65535;
    layer.cpu().object_id.at(8, 1) = 3;
    const auto method = method_named(GetParam());
    DisplayFrame frame;
    for (int repeat = 0; repeat < 2; ++repeat) {  // counters are those of the last warp, not a sum
        method->warp(layer, {camera, {}}, frame);
        EXPECT_EQ(method->counters().bad_depth, 4U);
        EXPECT_EQ(method->counters().unknown_object, 3U);
    }
    for (int x = 1; x <= 7; ++x) EXPECT_EQ(frame.coverage.at(x, 1), Coverage::hole) << x;
    EXPECT_EQ(frame.coverage.at(8, 1), Coverage::reached);
}

// Reference.

TEST(SplatMethod, AgreesWithReference) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({256, 192});
    const Camera target = moved(source, {0.06, 0.02, -0.05}, 3.0, -1.0, 1.0);
    const Layer layer = scene.draw(source, 0.0);
    const std::vector<ObjectTransform> movers = scene.movers(0.1);
    DisplayFrame splat = warp_once("splat", layer, {target, movers});
    DisplayFrame reference = warp_once("reference", layer, {target, movers});
    const auto fill = make_fill("none");  // so that holes are equal and covered pixels are told from them
    (*fill)->apply(splat, {});
    (*fill)->apply(reference, {});
    // Float places are off by up to 1e-4 px, so of 1e4 writes about two land on the other side of a pixel's edge or
    // of a step of the winner rule.
    EXPECT_TRUE(images_agree("splat-reference", splat.colour, reference.colour, 0, 2e-3));
}

TEST_P(DepthMethod, TheTargetMayHaveAnotherSizeAndView) {
    const AnalyticScene scene = AnalyticScene::wall(2.5);
    Camera source = street_camera({200, 160});
    source.fov = {-1.5, 1.4, -1.3, 1.2};
    Camera target = street_camera({64, 48});
    target.fov = {-0.8, 0.9, -0.7, 0.6};
    const DisplayFrame frame = warp_once(GetParam(), scene.draw(source, 0.0), {target, {}});
    ASSERT_EQ(frame.colour.size_px(), target.size_px);
    // A nearest source pixel is at most 0.5 px beside on both axes; the waves are 11 source pixels long with an
    // amplitude of 0.09 in linear light: 0.05 on both axes, 12 levels.
    EXPECT_TRUE(images_agree("size-" + GetParam(), frame.colour, scene.truth(target, 0.0, 1), 12));
}

TEST_P(DepthMethod, NothingOfTheSourceInViewLeavesHoles) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({64, 64});
    const Layer layer = scene.draw(source, 0.0);
    for (const double yaw_deg : {100.0, 180.0}) {  // nothing of the source is in view
        const DisplayFrame frame = warp_once(GetParam(), layer, {moved(source, {0.0, 0.0, 0.0}, yaw_deg), {}});
        EXPECT_THAT(frame.coverage.pixels(), ::testing::Each(Coverage::hole)) << yaw_deg;
    }
}

}  // namespace
}  // namespace lw::test
