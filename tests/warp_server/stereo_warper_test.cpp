#include "warp_server/stereo_warper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/metrics.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/hole_attribution.h"

namespace lw::test {
namespace {

constexpr glm::ivec2 kSize_px{96, 96};

StereoRig rig() { return mirrored_rig(0.063, street_camera(kSize_px).fov); }

Camera eye_of(const Camera& head, Eye eye) { return eye_camera(head, rig().eye(eye), head.world_from_eye); }

std::unique_ptr<StereoWarper> warper_for(StereoMode mode, std::string_view method = "surface",
                                         StereoSettings settings = {.rig = rig()}) {
    auto made = StereoWarper::create(method, "nearest-background", mode, street_camera(kSize_px), settings);
    EXPECT_TRUE(made.ok());
    return std::move(*made);
}

double psnr_of(const ColourImage& a, const ColourImage& b) { return psnr_db(a, b).value_or(99.0); }

// What the client publishes for a head.
RenderedFrame drawn(const AnalyticScene& scene, StereoMode mode, const Camera& head, const PictureMaker& maker) {
    const auto views = stereo_views(street_camera(kSize_px), rig(), mode);
    EXPECT_TRUE(views.ok());
    RenderedFrame frame;
    for (const DrawnView& view : *views) {
        Camera camera = view.camera;
        camera.world_from_eye = compose(head.world_from_eye, view.head_from_view);
        auto layer = std::make_shared<Layer>(scene.draw(camera, 0.0));
        layer->name = view.name;
        layer->for_eye = view.for_eye;
        maker.prepare(*layer);
        frame.layers.push_back(std::move(layer));
    }
    return frame;
}

TEST(StereoWarper, TwoRendersOfAStillHeadAreShownBitForBit) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = street_camera(kSize_px);
    const auto warper = warper_for(StereoMode::two_renders);
    const auto movers = scene.movers(0.0);
    warper->warp_eyes(drawn(scene, StereoMode::two_renders, head, *warper), {head, movers});
    for (const Eye eye : kEyes) {
        const Layer truth = scene.draw(eye_of(head, eye), 0.0);
        EXPECT_TRUE(warper->eye(eye).display_frame().colour == truth.cpu().colour) << name_of(eye);
    }
}

TEST(StereoWarper, OneRenderShowsEachEyeItsOwnView) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = moved(street_camera(kSize_px), {0.3, 0.0, -0.2}, 10.0, -5.0, 3.0);
    const auto warper = warper_for(StereoMode::one_render);
    const auto movers = scene.movers(0.0);
    warper->warp_eyes(drawn(scene, StereoMode::one_render, head, *warper), {head, movers});
    const auto right_than_wrong = [&](Eye shown, Eye other) {
        const ColourImage& picture = warper->eye(shown).display_frame().colour;
        const double own_db = psnr_of(picture, scene.truth(eye_of(head, shown), 0.0));
        const double other_db = psnr_of(picture, scene.truth(eye_of(head, other), 0.0));
        return own_db - other_db;
    };
    // The eyes' pictures differ by 20 px of parallax on the nearest things: the wrong one is far off.
    EXPECT_GT(right_than_wrong(Eye::left, Eye::right), 3.0);
    EXPECT_GT(right_than_wrong(Eye::right, Eye::left), 3.0);
}

TEST(StereoWarper, BothEyesOnTheirOwnThreadsShowTheSame) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = street_camera(kSize_px);
    const Camera now = moved(head, {0.05, 0.01, 0.0}, 2.0);
    const auto one_by_one = warper_for(StereoMode::one_render);
    const auto at_once = warper_for(StereoMode::one_render, "surface", {.rig = rig(), .parallel = true});
    const RenderedFrame frame = drawn(scene, StereoMode::one_render, head, *one_by_one);
    const auto movers = scene.movers(0.1);
    const ColourImage expected = one_by_one->warp(frame, {now, movers}).colour;
    for (int i = 0; i < 3; ++i) EXPECT_TRUE(at_once->warp(frame, {now, movers}).colour == expected);
}

// Everything of the street as static world, as item `item` of the nearest shell.
std::shared_ptr<Layer> street_item(const Camera& camera, std::uint32_t item) {
    auto layer = std::make_shared<Layer>(AnalyticScene::street().draw(camera, 0.0));
    layer->movers = {};
    std::ranges::fill(layer->cpu().object_id.pixels(), ObjectId{0});
    layer->content = {item, 0, true, 1.0F, camera.near_m};
    return layer;
}

TEST(StereoWarper, EyesThatTakeTurnsShowWhatEachShowsAlone) {
    const Camera head = street_camera(kSize_px);
    RenderedFrame view_alone;
    view_alone.layers = {street_item(head, 0)};
    // Past the view's edge a tile stands in, which is a stage of its own.
    RenderedFrame with_tile = view_alone;
    with_tile.layers.push_back(street_item(moved(head, {0.0, 0.0, 0.0}, 60.0), 1));
    const Camera turned = moved(head, {0.02, 0.0, 0.0}, 25.0);
    for (const bool parallel : {false, true}) {
        const auto warper = warper_for(StereoMode::one_render, "surface", {.rig = rig(), .parallel = parallel});
        ASSERT_TRUE(warper->eye(Eye::left).can_step());
        double holes = 1.0;
        for (const RenderedFrame* frame : {&view_alone, &with_tile}) {
            warper->warp_eyes(*frame, {turned, {}});
            for (const Eye eye : kEyes) {
                auto alone = FrameWarper::create("surface", "nearest-background");
                ASSERT_TRUE(alone.ok());
                const DisplayFrame& expected = alone->warp(*frame, {eye_of(turned, eye), {}, eye});
                const FrameWarper& shown = warper->eye(eye);
                EXPECT_TRUE(shown.display_frame().colour == expected.colour) << name_of(eye) << ", " << parallel;
                EXPECT_TRUE(shown.display_frame().coverage == expected.coverage) << name_of(eye) << ", " << parallel;
                if (!parallel) {
                    EXPECT_EQ(shown.counters().tiles_outside, alone->counters().tiles_outside);
                }
            }
            const double fewer = warper->eye(Eye::left).hole_fraction();
            EXPECT_LT(fewer, holes);
            holes = fewer;
        }
        warper->warp_eyes(with_tile, {turned, {}});
        EXPECT_EQ(warper->counters().pictures_reused, 2U) << "nothing moved";
    }
}

TEST(StereoWarper, ReportsTheHolesOfEachEyeWhereThatEyeLooks) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = street_camera(kSize_px);
    const auto warper = warper_for(StereoMode::one_render);
    const RenderedFrame frame = drawn(scene, StereoMode::one_render, head, *warper);
    const Camera turned = moved(head, {0.0, 0.0, 0.0}, 20.0);
    const auto movers = scene.movers(0.0);
    warper->warp_eyes(frame, {turned, movers});
    HoleFeedback both;
    warper->report_holes(frame, turned, both);
    HoleFeedback expected;
    for (const Eye eye : kEyes) {
        attribute_holes(warper->eye(eye).display_frame(), frame, eye_of(turned, eye), expected);
    }
    EXPECT_EQ(both.display_frames, 2U);
    EXPECT_EQ(both.holes_px, expected.holes_px);
}

TEST(StereoWarper, PacksBothEyes) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = street_camera(kSize_px);
    for (const std::string_view name : eye_layout_names()) {
        const EyeLayout layout = *find_eye_layout(name);
        const auto warper = warper_for(StereoMode::two_renders, "splat", {.rig = rig(), .layout = layout});
        const ColourImage& packed =
            warper->warp(drawn(scene, StereoMode::two_renders, head, *warper), {head, {}}).colour;
        ColourImage expected;
        pack_eyes(layout, warper->eye(Eye::left).display_frame().colour, warper->eye(Eye::right).display_frame().colour,
                  expected);
        EXPECT_TRUE(packed == expected) << name;
    }
}

TEST(StereoWarper, ScanlineShowsTheRightEyeAsDrawnAndTheLeftShifted) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera head = street_camera(kSize_px);
    const auto warper = warper_for(StereoMode::scanline);
    warper->warp_eyes(drawn(scene, StereoMode::scanline, head, *warper), {moved(head, {0.1, 0.0, 0.0}, 3.0), {}});
    const Layer right = scene.draw(eye_of(head, Eye::right), 0.0);
    EXPECT_TRUE(warper->eye(Eye::right).display_frame().colour == right.cpu().colour) << "the head is not followed";
    const double left_db =
        psnr_of(warper->eye(Eye::left).display_frame().colour, scene.draw(eye_of(head, Eye::left), 0.0).cpu().colour);
    const double unshifted_db = psnr_of(right.cpu().colour, scene.draw(eye_of(head, Eye::left), 0.0).cpu().colour);
    EXPECT_GT(left_db, unshifted_db + 2.0);
}

TEST(StereoWarper, ScanlineIsRefusedForTurnedEyes) {
    const StereoRig turned =
        mirrored_rig(0.063, street_camera(kSize_px).fov, glm::angleAxis(0.1, glm::dvec3{0.0, 1.0, 0.0}));
    const auto made =
        StereoWarper::create("surface", "none", StereoMode::scanline, street_camera(kSize_px), {.rig = turned});
    EXPECT_FALSE(made.ok());
}

TEST(StereoWarper, PixelsThatCouldNotBeUsedAreCountedForBothEyes) {
    const Camera head = street_camera(kSize_px);
    const auto warper = warper_for(StereoMode::one_render, "splat");
    auto layer = std::make_shared<Layer>(indexed_layer(head, 0.01F));
    layer->cpu().depth.at(3, 3) = -1.0F;
    RenderedFrame frame;
    frame.layers.push_back(std::move(layer));
    warper->warp_eyes(frame, {head, {}});
    EXPECT_EQ(warper->counters().bad_depth, 2U);
}

}  // namespace
}  // namespace lw::test
