// Billboards through the whole client: what they show is compared with the meshes they stand for.
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "tests/client_renderer/billboard_fixture.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

using namespace test;

// Texel centres lie on pixel centres, so only edges that the two rasterisations round differently may change: SSIM is
// far above the 0.98 that the look needs.
TEST_F(GlBillboards, FromWhereTheyWereDrawnShowWhatTheMeshesShow) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        for (const AtlasFormat format : {AtlasFormat::packed, AtlasFormat::document, AtlasFormat::full}) {
            BillboardSettings settings = with_mode(mode);
            settings.format = format;
            auto renderer = make(scene, settings);
            const CpuPixels shown = draw(*renderer, camera);
            EXPECT_EQ(renderer->billboards()->counters().created, 13U);
            EXPECT_EQ(renderer->billboards()->counters().active, 13U);
            const CpuPixels meshes = draw_meshes(*renderer, camera);
            EXPECT_GE(ssim(meshes.colour, shown.colour), 0.995);
            std::size_t far_off = 0;
            for (std::size_t i = 0; i < shown.depth.pixels().size(); ++i) {
                const float mesh = meshes.depth.pixels()[i];
                if (std::abs(shown.depth.pixels()[i] - mesh) > 0.01f * mesh) ++far_off;
            }
            // Edge pixels that belong to the floor in one and to a chair in the other.
            EXPECT_LE(far_off, shown.depth.pixels().size() / 200);
        }
    }
}

TEST_F(GlBillboards, FreshFlatAndWarpedOnesShowTheSame) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    auto flat = make(scene, with_mode(BillboardMode::flat));
    auto warped = make(scene, with_mode(BillboardMode::warped));
    EXPECT_EQ(draw(*flat, camera).colour, draw(*warped, camera).colour) << "no texel is blended at its centre";
}

// A step by which depth moves no pixel by more than a tenth: what differs is how texels are chosen.
TEST_F(GlBillboards, TexelsThatAreBlendedAreNearerToTheMeshes) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    const Camera later = moved(camera, {0.03, 0.02, 0.0});
    const auto likeness = [&](BillboardMode mode, bool blend_flat) {
        BillboardSettings settings = with_mode(mode);
        settings.error_cap_px = 1000.0;
        settings.blend_flat = blend_flat;
        auto renderer = make(scene, settings);
        (void)draw(*renderer, camera);
        const CpuPixels shown = draw(*renderer, later);
        EXPECT_EQ(renderer->billboards()->counters().updated, 0U);
        return ssim(draw_meshes(*renderer, later).colour, shown.colour);
    };
    const double nearest = likeness(BillboardMode::flat, false);
    EXPECT_GT(likeness(BillboardMode::flat, true), nearest);
    EXPECT_GT(likeness(BillboardMode::warped, false), nearest);
}

TEST_F(GlBillboards, ByTheErrorOfWarpedOnesBothModesAreDrawnAnewTogether) {
    const scene::Scene scene = few_chairs();
    std::vector<std::uint64_t> updates[3];
    const std::pair<BillboardMode, UpdateCriterion> ways[] = {{BillboardMode::warped, UpdateCriterion::error},
                                                              {BillboardMode::flat, UpdateCriterion::warped_error},
                                                              {BillboardMode::flat, UpdateCriterion::error}};
    for (std::size_t way = 0; way < std::size(ways); ++way) {
        BillboardSettings settings = with_mode(ways[way].first);
        settings.criterion = ways[way].second;
        settings.error_cap_px = 0.5;
        auto renderer = make(scene, settings);
        for (int frame = 0; frame < 5; ++frame) {
            (void)draw(*renderer, moved(outside(scene), {0.4 * frame, 0.0, 0.0}));
            updates[way].push_back(renderer->billboards()->counters().updated);
        }
    }
    EXPECT_GT(std::ranges::max(updates[0]), 0U);
    EXPECT_EQ(updates[0], updates[1]);
    EXPECT_NE(updates[0], updates[2]) << "flat ones by their own error";
}

TEST_F(GlBillboards, AllWaysToMakeQuadsGiveTheSamePicture) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    std::vector<CpuPixels> pictures;
    for (const QuadExpansion expansion : {QuadExpansion::geometry, QuadExpansion::instances, QuadExpansion::vertices}) {
        BillboardSettings settings = with_mode(BillboardMode::warped);
        settings.expansion = expansion;
        auto renderer = make(scene, settings);
        (void)draw(*renderer, camera);
        pictures.push_back(draw(*renderer, moved(camera, {0.05, 0.0, 0.0})));
    }
    EXPECT_EQ(pictures[0].colour, pictures[2].colour);
    EXPECT_EQ(pictures[1].colour, pictures[2].colour);
    EXPECT_EQ(pictures[0].depth, pictures[2].depth);
}

TEST_F(GlBillboards, AStillCameraUpdatesNothing) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    for (const UpdateCriterion criterion : {UpdateCriterion::angles, UpdateCriterion::error}) {
        BillboardSettings settings = with_mode(BillboardMode::warped);
        settings.criterion = criterion;
        auto renderer = make(scene, settings);
        const CpuPixels first = draw(*renderer, camera);
        for (int frame = 0; frame < 3; ++frame) {
            const CpuPixels next = draw(*renderer, camera);
            EXPECT_EQ(renderer->billboards()->counters().updated, 0U);
            EXPECT_EQ(renderer->billboards()->counters().created, 0U);
            EXPECT_EQ(next.colour, first.colour);
        }
    }
}

// Pixels keep within the nearest texel, at a third of a pixel's spacing: what is lost is resampling, as in any warp. A
// flat quad squeezes its depth into a plane.
TEST_F(GlBillboards, WarpedOnesFollowTheEyeWhereFlatOnesDoNot) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    const Camera later = moved(camera, {1.0, 0.4, -1.2}, 0.06);
    double quality[2] = {};
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        BillboardSettings settings = with_mode(mode);
        settings.error_cap_px = 1000.0;
        auto renderer = make(scene, settings);
        (void)draw(*renderer, camera);
        const CpuPixels shown = draw(*renderer, later);
        EXPECT_EQ(renderer->billboards()->counters().updated, 0U);
        EXPECT_EQ(renderer->billboards()->counters().active, 13U);
        quality[mode == BillboardMode::warped ? 1 : 0] = ssim(draw_meshes(*renderer, later).colour, shown.colour);
    }
    EXPECT_GT(quality[1], 0.95);
    EXPECT_GT(quality[1], quality[0] + 0.005);
}

// What a ray passes beside must not show. Seen: 24 pixels too many and 90 missing, most of them hidden from where the
// billboards were drawn; with texels that may lie half of one beside the ray, 67 and 61.
TEST_F(GlBillboards, WarpedOnesDoNotGrow) {
    const scene::Scene scene = few_chairs(13);  // as movers, since their ids tell them from the floor
    const Camera camera = outside(scene);
    const Camera later = moved(camera, {2.0, 0.0, 0.0});
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.error_cap_px = 1000.0;
    auto renderer = make(scene, settings);
    (void)draw(*renderer, camera);
    const CpuPixels shown = draw(*renderer, later);
    const CpuPixels meshes = draw_meshes(*renderer, later);
    double too_many = 0.0;
    double missing = 0.0;
    for (std::size_t i = 0; i < shown.object_id.pixels().size(); ++i) {
        const bool object_shown = shown.object_id.pixels()[i] != 0;
        const bool object_there = meshes.object_id.pixels()[i] != 0;
        if (object_shown && !object_there) ++too_many;
        if (object_there && !object_shown) ++missing;
    }
    EXPECT_GT(missing, 20.0) << "what was hidden is missing";
    EXPECT_LT(too_many, 0.6 * missing);
}

// Steps that move nothing by more than about a texel against the rest of its object. Seen, in thousands: 723 and 677,
// 1,037 and 981, 1,388 and 956.
TEST_F(GlBillboards, WarpedOnesAreNearerThanFlatOnesAfterASmallStep) {
    const scene::Scene scene = few_chairs(13);  // as movers, since their ids tell them from the floor
    const Camera camera = outside(scene);
    for (const double step_m : {0.08, 0.15, 0.3}) {
        const Camera later = moved(camera, {step_m, 0.0, 0.0});
        double squares[2] = {};
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            BillboardSettings settings = with_mode(mode);
            settings.error_cap_px = 1000.0;
            auto renderer = make(scene, settings);
            (void)draw(*renderer, camera);
            const CpuPixels shown = draw(*renderer, later);
            const CpuPixels meshes = draw_meshes(*renderer, later);
            for (std::size_t i = 0; i < shown.object_id.pixels().size(); ++i) {
                if (meshes.object_id.pixels()[i] == 0 || shown.object_id.pixels()[i] == 0) continue;
                const glm::vec3 off = levels(shown.colour.pixels()[i]) - levels(meshes.colour.pixels()[i]);
                squares[mode == BillboardMode::warped ? 1 : 0] += glm::dot(off, off);
            }
        }
        EXPECT_LT(squares[1], squares[0]) << step_m << " m";
    }
}

TEST_F(GlBillboards, KeepTheIdsOfMovers) {
    const scene::Scene scene = few_chairs(6);
    const Camera camera = outside(scene);
    auto renderer = make(scene, with_mode(BillboardMode::warped));
    (void)draw(*renderer, camera, 0.0);
    const CpuPixels shown = draw(*renderer, camera, 0.1);
    const CpuPixels meshes = draw_meshes(*renderer, camera, 0.1);
    std::size_t different = 0;
    std::size_t of_movers = 0;
    for (std::size_t i = 0; i < shown.object_id.pixels().size(); ++i) {
        if (meshes.object_id.pixels()[i] != 0) ++of_movers;
        if (shown.object_id.pixels()[i] != meshes.object_id.pixels()[i]) ++different;
    }
    EXPECT_GT(of_movers, 200U);
    EXPECT_LE(different, of_movers / 5) << "outlines, resampled";
}

TEST_F(GlBillboards, ATurningObjectUpdatesWhileTheOthersDoNot) {
    const scene::Scene scene = few_chairs(1);
    const Camera camera = outside(scene);
    auto renderer = make(scene, with_mode(BillboardMode::warped));
    (void)draw(*renderer, camera, 0.0);
    (void)draw(*renderer, camera, 2.0);  // a turn of 30 degrees or more
    EXPECT_EQ(renderer->billboards()->counters().updated, 1U);
}

TEST_F(GlBillboards, TruthNeverShowsThem) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene, {64, 64});
    auto with = make(scene, with_mode(BillboardMode::flat));
    auto without = make(scene, {});
    (void)draw(*with, camera);
    ColourImage a;
    ColourImage b;
    with->draw_supersampled(camera, 0.0, 2, a);
    without->draw_supersampled(camera, 0.0, 2, b);
    EXPECT_EQ(a, b);
}

TEST_F(GlBillboards, SeveralSamplesPerPixelShareOneChoice) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene, {128, 128});
    auto renderer = make(scene, with_mode(BillboardMode::warped));
    CpuPixels shown;
    renderer->draw_resolved(camera, 0.0, 2, shown);
    EXPECT_EQ(renderer->billboards()->counters().active, 13U);
    renderer->use_billboards(false);
    CpuPixels meshes;
    renderer->draw_resolved(camera, 0.0, 2, meshes);
    EXPECT_GE(ssim(meshes.colour, shown.colour), 0.99);
}

/// Every picture must be that of the meshes, bit for bit.
TEST_F(GlBillboards, WithoutRoomEverythingIsAMesh) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.capacities = {};
    auto renderer = make(scene, settings);
    const CpuPixels shown = draw(*renderer, camera);
    EXPECT_EQ(renderer->billboards()->counters().atlas_meshes, 13U);
    EXPECT_EQ(renderer->billboards()->counters().active, 0U);
    EXPECT_EQ(shown.colour, draw_meshes(*renderer, camera).colour);
}

TEST_F(GlBillboards, FullAtlasesLeaveTheRestAsMeshes) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.capacities = {1, 1, 1, 1, 1, 0};
    auto renderer = make(scene, settings);
    const CpuPixels shown = draw(*renderer, camera);
    EXPECT_EQ(renderer->billboards()->counters().active, 5U);
    EXPECT_EQ(renderer->billboards()->counters().atlas_meshes, 8U);
    // Some got slots that are too small for them: coarse, but whole and in place.
    EXPECT_GE(ssim(draw_meshes(*renderer, camera).colour, shown.colour), 0.9);
}

// All slots of 128 texels at once are 84 MB, which a software GL takes 33 ms to give.
TEST_F(GlBillboards, MemoryIsTakenByPages) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.capacities = {512, 512, 512, 512, 512, 128};
    auto renderer = make(scene, settings);
    const auto bytes = [&] { return renderer->billboards()->bytes(); };
    EXPECT_EQ(std::ranges::max(bytes()), 0U) << "nothing was drawn";
    (void)draw(*renderer, camera);
    EXPECT_EQ(renderer->billboards()->counters().active, 13U);
    EXPECT_GT(std::ranges::max(bytes()), 0U);
    EXPECT_LE(std::ranges::max(bytes()), std::size_t{10} << 19) << "13 billboards fit on one page of each size";
}

// Slots of 512 lie two on a page, so the wanted ones are on pages of their own.
TEST_F(GlBillboards, OnSeveralPagesTheyShowWhatTheyShowOnOne) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.capacities = {0, 0, 0, 0, 0, 16};
    auto renderer = make(scene, settings);
    const CpuPixels first = draw(*renderer, camera);
    EXPECT_EQ(renderer->billboards()->counters().active, 13U);
    EXPECT_EQ(renderer->billboards()->bytes().back(), 7 * (std::size_t{10} << 19)) << "seven pages of two";
    EXPECT_EQ(draw(*renderer, camera).colour, first.colour);
    // A slot with room for more than three texels per pixel has more of them, an odd number, so the centres stay.
    EXPECT_GE(ssim(draw_meshes(*renderer, camera).colour, first.colour), 0.995);
}

TEST_F(GlBillboards, WhatFallsOutOfAQueueIsAMesh) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.max_creations = 4;
    settings.max_updates = 2;
    settings.error_cap_px = 0.05;
    auto renderer = make(scene, settings);
    for (const std::uint64_t active : {4U, 8U, 12U, 13U}) {
        (void)draw(*renderer, camera);
        EXPECT_EQ(renderer->billboards()->counters().active, active);
    }
    (void)draw(*renderer, moved(camera, {1.0, 0.0, 0.0}));
    EXPECT_EQ(renderer->billboards()->counters().updated, 2U);
    EXPECT_EQ(renderer->billboards()->counters().queue_meshes, 11U);
    EXPECT_EQ(renderer->billboards()->counters().active, 2U);
}

TEST_F(GlBillboards, NoQueueAtAllMeansMeshes) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::flat);
    settings.max_creations = 0;
    auto renderer = make(scene, settings);
    EXPECT_EQ(draw(*renderer, camera).colour, draw_meshes(*renderer, camera).colour);
}

TEST_F(GlBillboards, AroundTheEyeAndAcrossTheNearPlaneAreMeshes) {
    const scene::Scene scene = few_chairs();
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        BillboardSettings settings = with_mode(mode);
        settings.mesh_distance_share = 0.0;  // nothing is too near by distance alone
        auto renderer = make(scene, settings);
        Camera camera = outside(scene);
        (void)draw(*renderer, camera);
        scene::SceneState state{scene};
        state.set_time(0.0);
        camera.world_from_eye.position_m = glm::dvec3{state.world_from_object(scene.instances[3])[3]};
        const CpuPixels shown = draw(*renderer, camera);
        EXPECT_GE(renderer->billboards()->counters().near_meshes, 1U);
        const CpuPixels meshes = draw_meshes(*renderer, camera);
        EXPECT_GE(ssim(meshes.colour, shown.colour), 0.95);
    }
}

TEST_F(GlBillboards, BadBoundsAreCountedAndDrawnAsMeshes) {
    scene::Scene scene = few_chairs();
    scene::Node& flattened = scene.nodes[static_cast<std::size_t>(scene.instances[1].node)];
    flattened.scale = {0.0, 1.0, 1.0};  // no inverse
    scene.meshes[static_cast<std::size_t>(scene.instances[2].mesh)].bounds.max.x =
        std::numeric_limits<double>::infinity();
    const Camera camera = outside(scene);
    auto renderer = make(scene, with_mode(BillboardMode::warped));
    const CpuPixels shown = draw(*renderer, camera);
    EXPECT_GE(renderer->billboards()->counters().bad_bounds, 2U);
    EXPECT_GE(ssim(draw_meshes(*renderer, camera).colour, shown.colour), 0.99);
}

TEST_F(GlBillboards, ObjectsThatTouchShareOneBillboard) {
    scene::Scene scene = few_chairs();
    const glm::dvec3 beside = scene.nodes[static_cast<std::size_t>(scene.instances[1].node)].translation;
    scene.nodes[static_cast<std::size_t>(scene.instances[2].node)].translation = beside + glm::dvec3{0.3, 0.0, 0.0};
    scene.finish();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::flat);
    settings.group_touching = true;
    auto renderer = make(scene, settings);
    const CpuPixels shown = draw(*renderer, camera);
    EXPECT_LE(renderer->billboards()->counters().active, 12U);
    EXPECT_GE(ssim(draw_meshes(*renderer, camera).colour, shown.colour), 0.995);
}

TEST_F(GlBillboards, ABudgetLeavesUpdatesForLater) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.error_cap_px = 0.15;
    settings.budget_ms = 2.5;  // by the fixed model: about three of 13 objects of 6,000-9,000 triangles
    auto renderer = make(scene, settings);
    (void)draw(*renderer, camera);
    Camera camera_now = camera;
    std::uint64_t stale = 0;
    for (int frame = 0; frame < 40; ++frame) {
        camera_now = moved(camera_now, {0.02, 0.0, 0.0});
        (void)draw(*renderer, camera_now);
        stale += renderer->billboards()->counters().stale;
        EXPECT_EQ(renderer->billboards()->counters().active, 13U) << "late, but shown";
    }
    EXPECT_GT(stale, 0U);
}

}  // namespace
}  // namespace lw
