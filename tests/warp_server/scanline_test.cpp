#include "warp_server/methods/scanline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/reprojection.h"
#include "core/stereo_rig.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

constexpr double kIpd_m = 0.063;

struct Eyes {
    Camera left;
    Camera right;
};

Eyes eyes_of(const Camera& head, const StereoRig& rig) {
    return {eye_camera(head, rig.eye(Eye::left), head.world_from_eye),
            eye_camera(head, rig.eye(Eye::right), head.world_from_eye)};
}

Eyes parallel_eyes(glm::ivec2 size_px) { return eyes_of(street_camera(size_px), mirrored_rig(kIpd_m, FovTangents{})); }

DisplayFrame shifted(const Layer& layer, const Camera& target, WarpCounters* counters = nullptr) {
    DisplayFrame out;
    WarpCounters own;
    shift_rows(layer.cpu(), layer.camera, target, out, counters != nullptr ? *counters : own);
    return out;
}

// Where pixel (x, y) of a layer whose colours are indices arrived, or -1.
int arrival_of(const DisplayFrame& frame, const Layer& layer, int x, int y) {
    const Rgba8 colour = layer.cpu().colour.at(x, y);
    for (int i = 0; i < frame.colour.width(); ++i) {
        if (frame.coverage.at(i, y) == Coverage::reached && frame.colour.at(i, y) == colour) return i;
    }
    return -1;
}

TEST(Scanline, EyesInOnePlaceSeeTheSame) {
    const Layer layer = noise_layer(street_camera({64, 16}));
    const DisplayFrame out = shifted(layer, layer.camera);
    EXPECT_TRUE(out.colour == layer.cpu().colour);
    EXPECT_TRUE(out.depth == layer.cpu().depth);
}

TEST(Scanline, APlaneMovesByItsParallax) {
    const Eyes eyes = parallel_eyes({64, 4});
    // 32 px per unit tangent: at 0.5 m the eyes' distance is 4.03 px. The left eye sees it farther to the right.
    const Layer layer = indexed_layer(eyes.right, static_cast<float>(eyes.right.near_m / 0.5));
    const DisplayFrame out = shifted(layer, eyes.left);
    EXPECT_EQ(arrival_of(out, layer, 10, 2), 14);
    for (int x = 0; x < 4; ++x) EXPECT_EQ(out.coverage.at(x, 1), Coverage::hole) << "uncovered at the left border";
    EXPECT_EQ(out.coverage.at(4, 1), Coverage::reached);
}

TEST(Scanline, TheSkyDoesNotMoveBetweenParallelEyes) {
    const Eyes eyes = parallel_eyes({64, 4});
    const Layer layer = indexed_layer(eyes.right, 0.0F);
    EXPECT_TRUE(shifted(layer, eyes.left).colour == layer.cpu().colour);
}

TEST(Scanline, EveryPixelLandsWhereTheReprojectionChainPutsIt) {
    const Camera head = street_camera({64, 8});
    const StereoRig rig = mirrored_rig(kIpd_m, {-1.376, 0.839, -1.0, 1.0});
    const Eyes eyes = eyes_of(head, rig);
    for (const float depth : {0.0F, 0.02F, 0.1F}) {
        const Layer layer = indexed_layer(eyes.right, depth);
        const DisplayFrame out = shifted(layer, eyes.left);
        const auto to_left = static_target_px_from_source_px(eyes.right, eyes.left);
        for (int x = 0; x < 64; ++x) {
            const auto place = reproject(to_left, {x + 0.5, 3.5}, depth);
            ASSERT_TRUE(place.has_value());
            const bool inside = place->position_px.x >= 0.0 && place->position_px.x < 64.0;
            EXPECT_EQ(arrival_of(out, layer, x, 3), inside ? static_cast<int>(place->position_px.x) : -1) << x;
        }
    }
}

TEST(Scanline, NearerPixelsWinForEitherEye) {
    const Eyes eyes = parallel_eyes({64, 1});
    for (const bool to_the_left : {true, false}) {
        const Camera& source = to_the_left ? eyes.right : eyes.left;
        const Camera& target = to_the_left ? eyes.left : eyes.right;
        Layer layer = indexed_layer(source, 0.0F);
        // A post at 0.5 m, 4 px of parallax before a sky that does not move.
        for (int x = 30; x < 33; ++x) layer.cpu().depth.at(x, 0) = static_cast<float>(source.near_m / 0.5);
        const DisplayFrame out = shifted(layer, target);
        for (int x = 30; x < 33; ++x) EXPECT_EQ(arrival_of(out, layer, x, 0), to_the_left ? x + 4 : x - 4);
        EXPECT_EQ(out.coverage.at(31, 0), Coverage::hole) << "behind the post";
    }
}

TEST(Scanline, BadDepthsAreCountedAndSkipped) {
    const Eyes eyes = parallel_eyes({16, 2});
    Layer layer = indexed_layer(eyes.right, 0.0F);
    layer.cpu().depth.at(3, 0) = std::numeric_limits<float>::quiet_NaN();
    layer.cpu().depth.at(4, 1) = 2.0F;
    WarpCounters counters;
    const DisplayFrame out = shifted(layer, eyes.left, &counters);
    EXPECT_EQ(counters.bad_depth, 2U);
    EXPECT_EQ(out.coverage.at(3, 0), Coverage::hole);
}

TEST(Scanline, SeesWhatTheOtherEyeSeesButForHolesAndSampling) {
    const AnalyticScene scene = AnalyticScene::street();
    const Eyes eyes = parallel_eyes({128, 128});
    const Layer layer = scene.draw(eyes.right, 0.0);
    const DisplayFrame out = shifted(layer, eyes.left);
    const Layer truth = scene.draw(eyes.left, 0.0);
    const Image<int> solids = scene.solid_at(eyes.left, 0.0);
    const Image<std::uint8_t> seen = scene.seen_by_source(eyes.left, 0.0, eyes.right, 0.0);
    int seen_px = 0;
    int near_px = 0;
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            if (seen.at(x, y) == 0 || out.coverage.at(x, y) != Coverage::reached || solids.at(x, y) < 0) continue;
            ++seen_px;
            const double ratio = out.depth.at(x, y) / truth.cpu().depth.at(x, y);
            near_px += std::abs(ratio - 1.0) < 0.1 ? 1 : 0;
        }
    }
    ASSERT_GT(seen_px, 5000);
    // Whole pixels: at edges of things a pixel's width belongs to what is beside.
    EXPECT_GT(near_px, 0.97 * seen_px);
}

TEST(Scanline, MethodIsRefusedForEyesThatAreNotSideBySide) {
    const Camera head = street_camera({16, 16});
    StereoRig rig = mirrored_rig(kIpd_m, head.fov);
    EXPECT_TRUE(make_scanline_method(eyes_of(head, rig).right, eyes_of(head, rig).left).ok());
    rig.eyes[0].head_from_eye.position_m.y = 0.01;
    const auto refused = make_scanline_method(eyes_of(head, rig).right, eyes_of(head, rig).left);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().where.find("up vector is not perpendicular"), std::string::npos);
}

TEST(Scanline, MethodFollowsNoHead) {
    const Eyes eyes = parallel_eyes({32, 8});
    const Layer layer = indexed_layer(eyes.right, 0.1F);
    auto method = make_scanline_method(eyes.right, eyes.left);
    ASSERT_TRUE(method.ok());
    DisplayFrame out;
    (*method)->warp(layer, {moved(eyes.left, {0.2, 0.1, 0.0}, 10.0), {}}, out);
    EXPECT_TRUE(out.coverage == shifted(layer, eyes.left).coverage);
}

}  // namespace
}  // namespace lw::test
