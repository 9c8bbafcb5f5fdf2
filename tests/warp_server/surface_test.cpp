/// What `surface` promises beyond the common ladder: exact places, clean edges, and more quality than its peers.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/colour.h"
#include "core/metrics.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/fill.h"
#include "warp_server/frame_warper.h"

namespace lw::test {
namespace {

struct Motion {
    const char* name;
    glm::dvec3 offset_m;
    double yaw_deg;
    double pitch_deg;
    double age_s;
};
constexpr Motion kMotions[] = {{"1 cm, 1 degree", {0.008, 0.003, -0.006}, 1.0, 0.4, 0.05},
                               {"4 cm, 4 degrees", {0.03, 0.01, -0.025}, 4.0, 1.0, 0.1}};

// How far `actual` is displaced against `expected`, px: least squares over both gradients (Lucas and Kanade 1981).
glm::dvec2 displacement_px(const ColourImage& actual, const ColourImage& expected, glm::ivec2 begin, glm::ivec2 end) {
    const auto level = [](const ColourImage& image, int x, int y) {
        return static_cast<double>(linear_of(image.at(x, y)).g);
    };
    double xx = 0.0;
    double xy = 0.0;
    double yy = 0.0;
    double x_error = 0.0;
    double y_error = 0.0;
    for (int y = begin.y; y < end.y; ++y) {
        for (int x = begin.x; x < end.x; ++x) {
            const double gradient_x = 0.5 * (level(expected, x + 1, y) - level(expected, x - 1, y));
            const double gradient_y = 0.5 * (level(expected, x, y + 1) - level(expected, x, y - 1));
            const double error = level(actual, x, y) - level(expected, x, y);
            xx += gradient_x * gradient_x;
            xy += gradient_x * gradient_y;
            yy += gradient_y * gradient_y;
            x_error += gradient_x * error;
            y_error += gradient_y * error;
        }
    }
    const double determinant = xx * yy - xy * xy;
    return glm::dvec2{yy * x_error - xy * y_error, xx * y_error - xy * x_error} / -determinant;
}

TEST(SurfaceMethod, ATexturedPlaneLandsWithinATwentiethOfAPixel) {
    const AnalyticScene scene = AnalyticScene::wall(2.0, 0.4);
    const Camera source = street_camera({200, 160});
    const Layer layer = scene.draw(source, 0.0);
    const Camera targets[] = {moved(source, {0.05, -0.03, 0.2}, 2.0, -1.0, 3.0), moved(source, {0.1, 0.0, -0.3}, -3.0),
                              moved(source, {0.0, 0.0, 0.0}, 5.0, 2.0)};
    for (const Camera& target : targets) {
        const DisplayFrame frame = warp_once("surface", layer, {target, {}});
        const ColourImage truth = scene.truth(target, 0.0, 1);
        for (int y = 20; y + 52 <= 140; y += 32) {  // blocks of 32 px, a wave long, that the source saw wholly
            for (int x = 40; x + 32 <= 150; x += 32) {
                const glm::dvec2 off = displacement_px(frame.colour, truth, {x, y}, {x + 32, y + 32});
                EXPECT_LT(glm::length(off), 0.05) << "block " << x << ", " << y;
            }
        }
    }
}

TEST(SurfaceMethod, InsideSurfacesTheColourIsThatOfTheTruth) {
    const AnalyticScene scene = AnalyticScene::wall(2.0);
    const Camera source = street_camera({160, 120});
    const Camera target = moved(source, {0.02, 0.01, 0.3}, 1.0);
    const DisplayFrame frame = warp_once("surface", scene.draw(source, 0.0), {target, {}});
    const ColourImage truth = scene.truth(target, 0.0, 1);
    const auto reached = [&](int x, int y) { return frame.coverage.at(x, y) == Coverage::reached; };
    for (int y = 1; y + 1 < 120; ++y) {
        for (int x = 1; x + 1 < 160; ++x) {
            // Beside the rim of the source its outermost half pixel repeats.
            const bool inside = reached(x - 1, y) && reached(x + 1, y) && reached(x, y - 1) && reached(x, y + 1);
            if (!inside) continue;
            // Bilinear reading of waves 12 px long loses up to (pi / 12)^2 / 2 = 3.4 % of their amplitude on each axis,
            // which is 25 levels where they are darkest: 1.7, plus a step of rounding in source and result each.
            ASSERT_NEAR(frame.colour.at(x, y).g, truth.at(x, y).g, 4) << x << ", " << y;
        }
    }
}

TEST(SurfaceMethod, ColoursAreNotMixedAcrossAnEdge) {
    // A black strip before white: beside the strip's new place only those two and mixtures of pixels that both cover.
    Camera source = street_camera({64, 32});
    Layer layer = indexed_layer(source, 0.01F);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool strip = x >= 24 && x < 40;
            layer.cpu().depth.at(x, y) = strip ? 0.05F : 0.01F;
            layer.cpu().colour.at(x, y) = strip ? Rgba8{0, 0, 0, 255} : Rgba8{255, 255, 255, 255};
        }
    }
    const DisplayFrame frame = warp_once("surface", layer, {moved(source, {0.4, 0.0, 0.0}, 0.0), {}});
    // The strip, 1 m away, moves by 6.4 px to 17.6..33.6; the wall, 5 m away, by 1.28 px.
    int grey = 0;
    for (int x = 8; x < 60; ++x) {
        if (frame.coverage.at(x, 16) == Coverage::hole) continue;
        const int level = frame.colour.at(x, 16).g;
        const bool in_strip = x >= 18 && x < 33;
        const bool at_edge = x == 17 || x == 33;
        if (at_edge) {
            grey += level > 0 && level < 255 ? 1 : 0;
        } else {
            EXPECT_EQ(level, in_strip ? 0 : 255) << x;
        }
    }
    EXPECT_GE(grey, 1);                                    // the edge that covers the wall shows both
    EXPECT_EQ(frame.coverage.at(35, 16), Coverage::hole);  // uncovered: nobody knows what is there
}

// A head that turns by about a thousandth of a pixel in the middle of a picture 96 px wide, two at its rim.
Camera hardly_turned(const Camera& source) { return moved(source, {0.0, 0.0, 0.0}, 0.001 * 90.0 / 96.0); }

TEST(SurfaceMethod, ATinyMotionChangesThePictureLittle) {
    // Coverage along edges fades in with the motion: a thousandth of a pixel must not show.
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({96, 96});
    const Layer layer = scene.draw(source, 0.0);
    const DisplayFrame frame = warp_once("surface", layer, {hardly_turned(source), layer.movers});
    // A thousandth of the step between black and white is a third of a level in light, up to 2 in the darkest colours.
    EXPECT_TRUE(images_agree("surface-tiny", frame.colour, layer.cpu().colour, 2));
}

// A black strip 1 m away before white 5 m away, its edges `share` of a pixel left of where columns 24 and 40 begin.
Layer strip_layer(const Camera& source, double share) {
    Layer layer = indexed_layer(source, 0.01F);
    layer.cpu().alpha_is_share = true;
    const auto part = [](double of_one) { return static_cast<std::uint8_t>(std::lround(255.0 * of_one)); };
    for (int y = 0; y < source.size_px.y; ++y) {
        for (int x = 0; x < source.size_px.x; ++x) {
            const bool strip = x >= 24 && x < 40;
            layer.cpu().depth.at(x, y) = strip ? 0.05F : 0.01F;
            const auto level = static_cast<std::uint8_t>(strip ? 0 : 255);
            const bool cut = x == 23 || x == 39;  // by the strip's left edge, and by its right one
            layer.cpu().colour.at(x, y) = {level, level, level, cut ? part(1.0 - share) : std::uint8_t{255}};
        }
    }
    return layer;
}

TEST(SurfaceMethod, SharesFadeInWithTheMotion) {
    const Camera source = street_camera({96, 96});
    Layer layer = strip_layer(source, 0.4);
    const DisplayFrame still = warp_once("surface", layer, {source, {}});
    const DisplayFrame moving = warp_once("surface", layer, {hardly_turned(source), {}});
    for (Rgba8& colour : layer.cpu().colour.pixels()) colour = opaque(colour);
    EXPECT_EQ(still.colour, layer.cpu().colour);
    // After 2/1000 px shares of up to a half count 1/125: 0.4 % of white light is level 13.
    EXPECT_TRUE(images_agree("shares-tiny", moving.colour, layer.cpu().colour, 13));
}

TEST(SurfaceMethod, SharesSayWhereInAPixelAnEdgeRuns) {
    const Camera source = street_camera({64, 32});
    // The strip moves by 6.4 px to 17.6 - share .. 33.6 - share: at 0.4, its left edge lies in pixel 17.
    for (const double share : {0.0, 0.2, 0.4}) {
        const DisplayFrame frame =
            warp_once("surface", strip_layer(source, share), {moved(source, {0.4, 0.0, 0.0}, 0.0), {}});
        double white = 0.0;
        for (int x = 14; x < 21; ++x) white += linear_of(frame.colour.at(x, 16)).g;
        // Between columns the edge is interpolated, which spreads it over two pixels and keeps its place.
        EXPECT_NEAR(white, 3.6 - share, 0.12) << share;
    }
}

TEST(SurfaceMethod, AWireIsAsWideAsItsShare) {
    // Column 24 is a black wire 1 m away that covers a part of it, before white 5 m away.
    const Camera source = street_camera({64, 32});
    for (const double share : {0.4, 0.6, 1.0}) {
        Layer layer = indexed_layer(source, 0.01F);
        layer.cpu().alpha_is_share = true;
        for (int y = 0; y < 32; ++y) {
            for (int x = 0; x < 64; ++x) {
                layer.cpu().depth.at(x, y) = x == 24 ? 0.05F : 0.01F;
                layer.cpu().colour.at(x, y) = {255, 255, 255, 255};
            }
            layer.cpu().colour.at(24, y) = {0, 0, 0, static_cast<std::uint8_t>(std::lround(255.0 * share))};
        }
        auto warper = FrameWarper::create("surface", "nearest-background");
        ASSERT_TRUE(warper.ok());
        RenderedFrame rendered;
        rendered.layers = {std::make_shared<Layer>(std::move(layer))};
        for (const double aside_m : {0.4, 0.41, 0.42, 0.43}) {  // 6.4 px and on
            const DisplayFrame& frame = warper->warp(rendered, {moved(source, {aside_m, 0.0, 0.0}, 0.0), {}});
            double black = 0.0;
            for (int x = 14; x < 22; ++x) black += 1.0 - linear_of(frame.colour.at(x, 16)).g;
            // Sampled once per pixel, a wire narrower than that is wider or thinner by where it lies.
            EXPECT_NEAR(black, share, 0.2) << share << ", " << aside_m;
        }
    }
}

TEST(SurfaceMethod, WhatIsNotSharedIsWhatTheFillFound) {
    const Camera source = street_camera({64, 32});
    auto warper = FrameWarper::create("surface", "nearest-background");
    ASSERT_TRUE(warper.ok());
    RenderedFrame rendered;
    rendered.layers = {std::make_shared<Layer>(strip_layer(source, 0.0))};
    const DisplayFrame& frame = warper->warp(rendered, {moved(source, {0.4, 0.0, 0.0}, 0.0), {}});
    // The strip's right edge, at 33.6, stands before what was hidden: pixel 33 is black by a part, white by the rest.
    EXPECT_EQ(frame.colour.at(32, 16).g, 0);
    EXPECT_NEAR(linear_of(frame.colour.at(33, 16)).g, 0.4F, 0.05F);
    EXPECT_EQ(frame.coverage.at(33, 16), Coverage::reached);
    EXPECT_EQ(frame.colour.at(34, 16).g, 255);
    EXPECT_EQ(frame.coverage.at(34, 16), Coverage::filled);
}

// Foliage: neighbours are on one of two planes, or on none but their own.
Layer leafy_layer(const Camera& camera) {
    Layer layer = indexed_layer(camera, 0.02F);
    std::uint32_t state = 1;
    for (float& depth : layer.cpu().depth.pixels()) {
        state = state * 1664525U + 1013904223U;
        const std::uint32_t kind = state >> 30U;
        if (kind == 1) depth = 0.05F;
        if (kind > 1) depth = 0.03F + 1e-10F * static_cast<float>(state >> 8U);
    }
    return layer;
}

// Whether a surface is drawn with others of its tile or alone, its cells begin and end at the same place: pixels in a
// strip of a thousandth of a pixel between the two were drawn by neither, and were holes in the middle of a tree.
TEST(SurfaceMethod, PlacesJustBeforeThePixelsCentresAreInOneCell) {
    const Camera source = street_camera({64, 64});
    const Layer layer = leafy_layer(source);
    const double tan_per_px = (source.fov.right - source.fov.left) / source.size_px.x;
    for (const double before_px : {2e-4, 5e-4, 8e-4, 1.5e-3}) {
        for (const glm::dvec2& shift_px : {glm::dvec2{-before_px, 0.3}, glm::dvec2{0.3, -before_px}}) {
            Camera target = source;
            target.fov.left += shift_px.x * tan_per_px;
            target.fov.right += shift_px.x * tan_per_px;
            target.fov.up -= shift_px.y * tan_per_px;
            target.fov.down -= shift_px.y * tan_per_px;
            const DisplayFrame frame = warp_once("surface", layer, {target, {}});
            EXPECT_EQ(std::ranges::count(frame.coverage.pixels(), Coverage::hole), 0)
                << shift_px.x << ", " << shift_px.y;
            EXPECT_TRUE(frame.partly_covered.empty()) << shift_px.x << ", " << shift_px.y;
        }
    }
}

struct Quality {
    double psnr_db = 0.0;
    double flip = 0.0;
};

Quality quality_of(const std::string& method, const Layer& layer, const Camera& target,
                   const std::vector<ObjectTransform>& movers, const ColourImage& truth) {
    DisplayFrame frame = warp_once(method, layer, {target, movers});
    (*make_fill("nearest-background"))->apply(frame, {});
    return {psnr_db(truth, frame.colour).value_or(99.0), flip(truth, frame.colour, pixels_per_degree(target)).mean};
}

TEST(SurfaceMethod, BeatsRotationSplatAndInverseOnceTheHeadMoves) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera target_size = street_camera({224, 224});
    Camera source = target_size;  // with a guard band, so that all see the same
    source.size_px += 128;
    const double reach = (224.0 + 128.0) / 224.0;
    source.fov = {-reach, reach, -reach, reach};
    const Layer layer = scene.draw(source, 0.0, 2);
    for (const Motion& motion : kMotions) {
        const Camera target = moved(target_size, motion.offset_m, motion.yaw_deg, motion.pitch_deg);
        const std::vector<ObjectTransform> movers = scene.movers(motion.age_s);
        const ColourImage truth = scene.truth(target, motion.age_s, 3);
        const Quality surface = quality_of("surface", layer, target, movers, truth);
        for (const char* other : {"rotation", "splat", "inverse"}) {
            const Quality theirs = quality_of(other, layer, target, movers, truth);
            EXPECT_GT(surface.psnr_db, theirs.psnr_db) << other << ", " << motion.name;
            EXPECT_LT(surface.flip, theirs.flip) << other << ", " << motion.name;
        }
    }
}

}  // namespace
}  // namespace lw::test
