#include "core/surface_match.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/core/card_scene.h"

namespace lw::test {
namespace {

Image<SurfacePlace> places(const CardPicture& from, const CardPicture& to, int threads = 1) {
    Image<SurfacePlace> all{from.camera.size_px};
    match_surfaces(from.view(), to.view(), threads,
                   [&](int x, int y, const SurfacePlace& place) { all.at(x, y) = place; });
    return all;
}

TEST(SurfaceMatch, InTheSamePictureEverySurfaceIsWhereItIs) {
    const CardPicture picture = draw_cards({}, card_camera(0.0));
    const auto all = places(picture, picture);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const SurfacePlace& place = all.at(x, y);
            ASSERT_EQ(place.visibility, Visibility::seen);
            ASSERT_NEAR(place.position_px.x, x + 0.5, 1e-9);
            ASSERT_NEAR(place.position_px.y, y + 0.5, 1e-9);
            float own = 0.0F;
            for (std::size_t i = 0; i < 4; ++i) {
                if (place.neighbours[i] == glm::ivec2{x, y}) own += place.weights[i];
            }
            ASSERT_NEAR(own, 1.0F, 1e-5F);
        }
    }
}

TEST(SurfaceMatch, TellsHiddenSurfacesFromSeenOnes) {
    // Focal length 32 px. The head moves 0.25 m to the right: the card moves 4 px to the left, the wall 0.8 px. So 3.2
    // px of wall, right of the card, are uncovered.
    const CardPicture source = draw_cards({}, card_camera(0.0));
    const CardPicture target = draw_cards({}, card_camera(0.25));
    const auto all = places(target, source);
    // The card covers 24..40 in the source and 20..36 in the target; the wall behind 40 in the source is at 39.2.
    for (int x = 0; x < 64; ++x) {
        const SurfacePlace& place = all.at(x, 32);
        const double shift_px = target.is_card(x, 32) ? 4.0 : 0.8;
        if (x == 63) {
            EXPECT_EQ(place.visibility, Visibility::outside);  // 63.5 + 0.8 lies beyond the border
            continue;
        }
        ASSERT_NEAR(place.position_px.x, x + 0.5 + shift_px, 1e-6) << x;
        // 38.5 + 0.8 = 39.3 lies between the card's last pixel centre, 39.5, and 38.5, both card.
        const bool hidden = x >= 36 && x <= 38;
        EXPECT_EQ(place.visibility, hidden ? Visibility::hidden : Visibility::seen) << x;
    }
}

TEST(SurfaceMatch, WhatTurnsOutOfThePictureIsOutside) {
    Camera turned = card_camera(0.0);
    const CardPicture target = draw_cards({}, turned);
    turned.world_from_eye.orientation = glm::angleAxis(std::numbers::pi / 4.0, glm::dvec3{0.0, 1.0, 0.0});
    CardPicture source = target;  // depth does not matter where it is outside
    source.camera = turned;
    const auto all = places(target, source);
    // Turned left by 45 degrees, the source sees the left half of the target's field and what is left of it.
    for (int x = 0; x < 64; ++x) EXPECT_EQ(all.at(x, 32).visibility == Visibility::outside, x >= 32) << x;
}

TEST(SurfaceMatch, SkyIsADirection) {
    CardPicture sky = draw_cards({}, card_camera(0.0));
    for (float& depth : sky.depth.pixels()) depth = 0.0F;
    CardPicture moved = sky;
    moved.camera.world_from_eye.position_m = {3.0, -2.0, 1.0};
    const SurfacePlace place = places(moved, sky).at(10, 20);
    EXPECT_EQ(place.visibility, Visibility::seen);
    EXPECT_NEAR(place.position_px.x, 10.5, 1e-9);
    EXPECT_NEAR(place.position_px.y, 20.5, 1e-9);
}

TEST(SurfaceMatch, FollowsAMoverAndHidesAnUnknownOne) {
    CardScene scene;
    scene.card_id = 7;
    const CardPicture source = draw_cards(scene, card_camera(0.0));
    scene.card_left_m += 0.5;  // 8 px
    scene.card_right_m += 0.5;
    CardPicture target = draw_cards(scene, card_camera(0.0));
    EXPECT_EQ(places(target, source).at(36, 5).visibility, Visibility::seen);
    EXPECT_NEAR(places(target, source).at(36, 5).position_px.x, 28.5, 1e-9);
    EXPECT_EQ(places(target, source).at(27, 5).visibility, Visibility::hidden) << "the card stood there";
    for (std::uint16_t& id : target.object_id.pixels()) id = id == 7 ? 8 : id;
    target.movers.clear();
    EXPECT_EQ(places(target, source).at(36, 5).visibility, Visibility::hidden);
}

TEST(SurfaceMatch, ASlantedPlaneMatchesItself) {
    // Depth is affine in pixels on any plane: a ground that comes as near as 0.35 m and whose distance doubles within a
    // few pixels at the horizon.
    Camera camera = card_camera(0.0);
    camera.near_m = 0.05;
    const auto ground = [](const Camera& seen_by) {
        CardPicture picture{seen_by, DepthImage{seen_by.size_px}, ObjectIdImage{seen_by.size_px}, {}};
        const double height_m = 0.35 + seen_by.world_from_eye.position_m.y;
        for (int y = 33; y < 64; ++y) {
            const double ray_down = (y + 0.5 - 32.0) / 32.0;
            for (float& depth : picture.depth.row(y)) depth = static_cast<float>(seen_by.near_m * ray_down / height_m);
        }
        return picture;
    };
    Camera moved = camera;
    moved.world_from_eye.position_m = {0.02, 0.03, -0.04};
    const auto all = places(ground(moved), ground(camera));
    for (int y = 35; y < 56; ++y) {
        for (int x = 12; x < 52; ++x) ASSERT_EQ(all.at(x, y).visibility, Visibility::seen) << x << " " << y;
    }
}

TEST(SurfaceMatch, ThreadsChangeNothing) {
    const CardPicture source = draw_cards({}, card_camera(0.0));
    const CardPicture target = draw_cards({}, card_camera(0.25));
    const auto one = places(target, source, 1);
    const auto three = places(target, source, 3);
    for (std::size_t i = 0; i < one.pixels().size(); ++i) {
        ASSERT_EQ(one.pixels()[i].visibility, three.pixels()[i].visibility);
        ASSERT_EQ(one.pixels()[i].position_px, three.pixels()[i].position_px);
    }
}

}  // namespace
}  // namespace lw::test
