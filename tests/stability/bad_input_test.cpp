/// Input that no renderer should send: nothing may crash, and nothing that is no number may reach the display.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/stability/case_random.h"
#include "apps/stability/stability_case.h"
#include "apps/stability/sweep.h"
#include "core/check.h"
#include "warp_server/frame_warper.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/registry.h"

namespace lw::stability {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

FrameWarper warper_of(const std::string& method) {
    Result<FrameWarper> made = FrameWarper::create(method, "nearest-background");
    LW_CHECK(made.ok(), method);
    return *std::move(made);
}

RenderedFrame frame_of(Layer layer) {
    RenderedFrame frame;
    frame.layers.push_back(std::make_shared<const Layer>(std::move(layer)));
    return frame;
}

// Every pixel is shown, opaque, with a depth that is one.
::testing::AssertionResult can_be_shown(const DisplayFrame& frame, glm::ivec2 size_px) {
    if (frame.colour.size_px() != size_px || frame.depth.size_px() != size_px) {
        return ::testing::AssertionFailure() << "size";
    }
    for (std::size_t i = 0; i < frame.depth.pixels().size(); ++i) {
        if (frame.coverage.pixels()[i] == Coverage::hole) return ::testing::AssertionFailure() << "hole at " << i;
        if (!is_usable_depth(frame.depth.pixels()[i])) {
            return ::testing::AssertionFailure() << "depth " << frame.depth.pixels()[i] << " at " << i;
        }
        if (frame.colour.pixels()[i].a != 255) return ::testing::AssertionFailure() << "see-through at " << i;
    }
    return ::testing::AssertionSuccess();
}

float random_bad_depth(CaseRandom& random) {
    constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(),
                              -std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(),
                              -std::numeric_limits<float>::infinity(),
                              -0.0F,
                              -1.0F,
                              1.0000001F,
                              1.0F,
                              2.0F,
                              3e38F,
                              1e-45F,
                              -1e-45F,
                              1e-38F};
    return kBad[random.whole(0, static_cast<int>(std::size(kBad)) - 1)];
}

double random_bad_number(CaseRandom& random) {
    constexpr double kBad[] = {kNan, kInfinite, -kInfinite, 0.0, -0.0, 1e-310, 1e300, -1e300, 1e-20, 1e20, 1.0};
    return kBad[random.whole(0, static_cast<int>(std::size(kBad)) - 1)];
}

void spoil_placements(std::vector<ObjectTransform>& objects, CaseRandom& random) {
    for (ObjectTransform& object : objects) {
        if (!random.chance(0.5)) continue;
        glm::dmat4& m = object.world_from_object;
        switch (random.whole(0, 4)) {
            case 0:  // one number
                m[random.whole(0, 3)][random.whole(0, 3)] = random_bad_number(random);
                break;
            case 1:  // singular: two axes in one
                m[1] = m[0];
                break;
            case 2:  // vanished
                m[0] = m[1] = m[2] = glm::dvec4{0.0};
                break;
            case 3:  // nearly flat
                m[2] = m[0] + m[1] * 1e-12;
                break;
            default:  // all of one length
                m *= random_bad_number(random);
                break;
        }
    }
}

// A case beyond the promised range with bad pixels, ids and placements in it.
struct SpoiltCase {
    Camera target;
    std::vector<ObjectTransform> at_target;
    Layer layer;
};

SpoiltCase spoilt_case(std::uint64_t seed) {
    CaseRandom random{seed + 77};
    StabilityCase made = make_case(seed, CaseRange::beyond);
    SpoiltCase spoilt{made.target, made.at_target, layer_of(made, CasePattern::lattice)};
    const double share = random.log_uniform(1e-3, 1.0);
    CpuPixels& pixels = spoilt.layer.cpu();
    for (float& depth : pixels.depth.pixels()) {
        if (random.chance(share)) depth = random_bad_depth(random);
    }
    for (ObjectId& id : pixels.object_id.pixels()) {
        if (random.chance(0.3 * share)) id = static_cast<ObjectId>(random.chance(0.5) ? 65535 : random.whole(0, 65535));
    }
    spoil_placements(spoilt.layer.movers, random);
    spoil_placements(spoilt.at_target, random);
    return spoilt;
}

class BadInput : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, BadInput, ::testing::ValuesIn(cpu_methods()));

TEST_P(BadInput, WhateverTheFrameHoldsThePictureCanBeShown) {
    FrameWarper warper = warper_of(GetParam());
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        SpoiltCase spoilt = spoilt_case(seed);
        const Camera target = spoilt.target;
        const std::vector<ObjectTransform> at_target = spoilt.at_target;
        const DisplayFrame& shown = warper.warp(frame_of(std::move(spoilt.layer)), {target, at_target});
        ASSERT_TRUE(can_be_shown(shown, target.size_px)) << "case " << seed;
    }
}

TEST_P(BadInput, BadPixelsAreCountedByKind) {
    StabilityCase made = make_case(3, CaseRange::promised);
    Layer layer = layer_of(made, CasePattern::lattice);
    layer.movers.clear();
    for (ObjectId& id : layer.cpu().object_id.pixels()) id = 0;
    layer.cpu().depth.pixels()[0] = std::numeric_limits<float>::quiet_NaN();
    layer.cpu().depth.pixels()[1] = 1.5F;
    layer.cpu().depth.pixels()[2] = -0.5F;
    layer.cpu().object_id.pixels()[3] = 9;
    layer.cpu().object_id.pixels()[4] = 65535;
    const Camera same = layer.camera;
    FrameWarper warper = warper_of(GetParam());
    (void)warper.warp(frame_of(std::move(layer)), {same, {}});
    EXPECT_EQ(warper.counters().bad_depth, 3U);
    // The two that know no objects show those pixels as they are.
    const bool knows_objects = GetParam() != "stale" && GetParam() != "rotation";
    EXPECT_EQ(warper.counters().unknown_object, knows_objects ? 2U : 0U);
}

TEST_P(BadInput, PicturesOfAnySize) {
    FrameWarper warper = warper_of(GetParam());
    for (const glm::ivec2& source_px : {glm::ivec2{1, 1}, {3, 5}, {1, 4096}, {8192, 16}, {2, 1}}) {
        for (const glm::ivec2& target_px : {glm::ivec2{1, 1}, {5, 3}, {8192, 16}, {1, 77}}) {
            StabilityCase made = make_case(5, CaseRange::promised);
            made.source.size_px = source_px;
            made.source.fov = {-1.0, 1.0, -1.0, 1.0};
            made.regions = {{0, 0, source_px.x, source_px.y, 0, {0.01L, 1e-7L, 0}}};
            Camera target = made.source;
            target.size_px = target_px;
            target.world_from_eye.position_m += glm::dvec3{0.01 * made.source.near_m, 0.0, 0.0};
            const DisplayFrame& shown = warper.warp(frame_of(layer_of(made, CasePattern::lattice)), {target, {}});
            EXPECT_TRUE(can_be_shown(shown, target_px)) << source_px.x << "x" << source_px.y;
        }
    }
}

// Points that come to lie in the eye's plane, in the near plane, and one rounding beside them.
TEST_P(BadInput, PointsInTheEyePlane) {
    FrameWarper warper = warper_of(GetParam());
    StabilityCase made = make_case(11, CaseRange::promised);
    made.source.size_px = {24, 20};
    made.source.fov = {-1.0, 1.0, -0.8, 0.8};
    made.source.near_m = 0.05;
    made.source.world_from_eye = {};
    made.regions = {{0, 0, 24, 20, 0, {0.05L, 0, 0}}};  // a wall 1 m ahead
    Camera target = made.source;
    for (const double depth : {1.0, 0.95}) {  // forward to the wall, and to where it is in the near plane
        for (const double nudge : {0.0, 1e-300, 1e-16, -1e-16, 1e-12, -1e-12, 1e-7, -1e-7, 1e-3}) {
            target.world_from_eye.position_m.z = -depth + nudge;
            const DisplayFrame& shown = warper.warp(frame_of(layer_of(made, CasePattern::lattice)), {target, {}});
            EXPECT_TRUE(can_be_shown(shown, target.size_px)) << depth << " " << nudge;
        }
    }
}

TEST_P(BadInput, ABadHeadPoseHoldsTheLastGoodOne) {
    const StabilityCase made = make_case(21, CaseRange::promised);
    const RenderedFrame frame = frame_of(layer_of(made, CasePattern::lattice));
    FrameWarper warper = warper_of(GetParam());
    const DisplayFrame good = warper.warp(frame, {made.target, made.at_target});
    EXPECT_EQ(warper.held().bad_head_pose, 0U);
    Camera bad = made.target;
    for (const Pose& pose :
         {Pose{{kNan, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, Pose{{0.0, kInfinite, 0.0}, {1.0, 0.0, 0.0, 0.0}},
          Pose{{}, {kNan, 0.0, 0.0, 0.0}}, Pose{{}, {0.0, 0.0, 0.0, 0.0}}, Pose{{}, {1e-9, 0.0, 1e-9, 0.0}},
          Pose{{}, {kInfinite, 1.0, 0.0, 0.0}}}) {
        bad.world_from_eye = pose;
        const DisplayFrame& shown = warper.warp(frame, {bad, made.at_target});
        EXPECT_EQ(warper.held().bad_head_pose, 1U);
        EXPECT_TRUE(shown.colour == good.colour);
    }
    // A quaternion of another length is the same turn.
    bad.world_from_eye = made.target.world_from_eye;
    bad.world_from_eye.orientation *= -3.0;
    (void)warper.warp(frame, {bad, made.at_target});
    EXPECT_EQ(warper.held().bad_head_pose, 0U);
}

TEST_P(BadInput, ABadPlacementHoldsTheLastGoodOne) {
    std::uint64_t seed = 0;
    while (make_case(seed, CaseRange::promised).at_target.size() < 3) ++seed;
    const StabilityCase made = make_case(seed, CaseRange::promised);
    const RenderedFrame frame = frame_of(layer_of(made, CasePattern::lattice));
    FrameWarper warper = warper_of(GetParam());
    const DisplayFrame good = warper.warp(frame, {made.target, made.at_target});
    std::vector<ObjectTransform> bad = made.at_target;
    bad[0].world_from_object[3].x = kNan;
    bad[2].world_from_object[1].w = 1.0;
    for (int repeat = 0; repeat < 2; ++repeat) {
        const DisplayFrame& shown = warper.warp(frame, {made.target, bad});
        EXPECT_EQ(warper.held().bad_placement, 2U);
        EXPECT_TRUE(shown.colour == good.colour);
    }
}

TEST_P(BadInput, ALayerWithoutACameraIsLeftOut) {
    const StabilityCase made = make_case(9, CaseRange::promised);
    const RenderedFrame good_frame = frame_of(layer_of(made, CasePattern::lattice));
    FrameWarper warper = warper_of(GetParam());
    const DisplayFrame good = warper.warp(good_frame, {made.target, made.at_target});
    const auto spoil = [&](auto change) {
        Layer layer = layer_of(made, CasePattern::lattice);
        change(layer.camera);
        const RenderedFrame bad_frame = frame_of(std::move(layer));
        RenderedFrame frame = bad_frame;
        frame.layers.push_back(good_frame.layers.front());
        EXPECT_TRUE(warper.warp(frame, {made.target, made.at_target}).colour == good.colour);
        EXPECT_EQ(warper.held().bad_layer, 1U);
        // Alone: the picture before is shown again.
        EXPECT_TRUE(warper.warp(bad_frame, {made.target, made.at_target}).colour == good.colour);
        // Before there was any picture: black.
        FrameWarper fresh = warper_of(GetParam());
        EXPECT_TRUE(can_be_shown(fresh.warp(bad_frame, {made.target, {}}), made.target.size_px));
    };
    spoil([](Camera& camera) { camera.fov.left = kNan; });
    spoil([](Camera& camera) { camera.fov.up = camera.fov.down; });
    spoil([](Camera& camera) { camera.near_m = 0.0; });
    spoil([](Camera& camera) { camera.near_m = kInfinite; });
    spoil([](Camera& camera) { camera.near_m = 1e-310; });
    spoil([](Camera& camera) { camera.world_from_eye.position_m.y = kNan; });
    spoil([](Camera& camera) { camera.world_from_eye.orientation = {0.0, 0.0, 0.0, 0.0}; });
}

}  // namespace
}  // namespace lw::stability
