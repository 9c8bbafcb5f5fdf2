/// What `surface` makes of edges in pixels whose quarters it knows.

#include "warp_server/methods/surface_edge_lattice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/colour.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

constexpr Rgba8 kBlack{0, 0, 0, 255};
constexpr Rgba8 kWhite{255, 255, 255, 255};

Rgba8 with_share(Rgba8 colour, double share) {
    colour.a = static_cast<std::uint8_t>(std::lround(255.0 * share));
    return colour;
}

// Black 1 m away up to the middle of column 23, white 1.05 m away beyond: two surfaces that move alike.
Layer half_plane(const Camera& source) {
    Layer layer = indexed_layer(source, 0.05F);
    CpuPixels& pixels = layer.cpu();
    pixels.alpha_is_share = true;
    pixels.quarters = ColourImage{2 * source.size_px};
    for (int y = 0; y < source.size_px.y; ++y) {
        for (int x = 0; x < source.size_px.x; ++x) {
            pixels.depth.at(x, y) = x < 24 ? 0.05F : 0.05F / 1.05F;
            pixels.colour.at(x, y) = x < 23 ? kBlack : x == 23 ? with_share(kBlack, 0.5) : kWhite;
        }
    }
    for (int y = 0; y < pixels.quarters.height(); ++y) {
        for (int x = 0; x < pixels.quarters.width(); ++x) {
            pixels.quarters.at(x, y) = x < 47 ? kBlack : x == 47 ? with_share(kWhite, 0.0) : kWhite;
        }
    }
    return layer;
}

// What is 1 m away moves to the left.
Camera shifted(const Camera& source, double shift_px) {
    const double px_per_m = source.size_px.x / (source.fov.right - source.fov.left);
    return moved(source, {shift_px / px_per_m, 0.0, 0.0}, 0.0);
}

TEST(SurfaceEdgeLattice, AnEdgeCoversWhatOfAPixelsAreaIsBeyondIt) {
    const Camera source = street_camera({48, 24});
    const Layer layer = half_plane(source);
    for (const double shift_px : {0.3, 0.4, 0.5}) {
        const DisplayFrame frame = warp_once("surface", layer, {shifted(source, shift_px), {}});
        // The pixel reaches from 23 + shift to 24 + shift, the edge lies at 23.75. White moves 5 % less, up to 0.035
        // px.
        EXPECT_NEAR(linear_of(frame.colour.at(23, 12)).g, 0.5 + shift_px, 0.03) << shift_px;
        EXPECT_EQ(opaque(frame.colour.at(22, 12)), kBlack) << shift_px;
        EXPECT_EQ(opaque(frame.colour.at(24, 12)), kWhite) << shift_px;
    }
}

TEST(SurfaceEdgeLattice, SharesOfQuartersFadeInWithTheMotion) {
    const Camera source = street_camera({48, 24});
    const Layer layer = half_plane(source);
    EXPECT_EQ(warp_once("surface", layer, {source, {}}).colour.at(23, 12), kBlack);
    // After 2/1000 px a share of a half counts 1/125, or little more: 1 % of white light is level 26.
    const DisplayFrame moving = warp_once("surface", layer, {shifted(source, 0.002), {}});
    EXPECT_LE(moving.colour.at(23, 12).g, 26);
}

TEST(SurfaceEdgeLattice, EdgesAtTheRimOfThePictureCountTheirLastQuartersAgain) {
    const Camera source = street_camera({24, 24});
    Layer layer = half_plane(street_camera({48, 24}));
    Layer last = indexed_layer(source, 0.05F);
    last.cpu().alpha_is_share = true;
    last.cpu().quarters = ColourImage{2 * source.size_px};
    // The picture ends in the column in which the edge lies.
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 24; ++x) last.cpu().colour.at(x, y) = layer.cpu().colour.at(x, y);
    }
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 48; ++x) last.cpu().quarters.at(x, y) = layer.cpu().quarters.at(x, y);
    }
    const DisplayFrame frame = warp_once("surface", last, {shifted(source, 0.4), {}});
    EXPECT_EQ(frame.coverage.at(23, 12), Coverage::reached);
}

// Two pixels: the left one is all black; of the right one, white, the left half shows black.
struct TwoPixels {
    CpuPixels pixels;

    explicit TwoPixels(float white_depth) {
        pixels.colour = ColourImage{{2, 1}};
        pixels.colour.at(0, 0) = kBlack;
        pixels.colour.at(1, 0) = with_share(kWhite, 0.5);
        pixels.depth = DepthImage{{2, 1}};
        pixels.depth.at(0, 0) = 0.05F;
        pixels.depth.at(1, 0) = white_depth;
        pixels.object_id = ObjectIdImage{{2, 1}};
        pixels.alpha_is_share = true;
        pixels.quarters = ColourImage{{4, 2}};
        for (int y = 0; y < 2; ++y) {
            pixels.quarters.at(0, y) = kBlack;
            pixels.quarters.at(1, y) = kBlack;
            pixels.quarters.at(2, y) = with_share(kBlack, 0.0);
            pixels.quarters.at(3, y) = kWhite;
        }
    }

    // Green of the right pixel's left upper quarter in a picture that is read between pixels.
    [[nodiscard]] int joined() const {
        const SurfaceLinks links{pixels};
        const LinearImage linear{pixels.colour, LinearAlpha::kept};
        LinearImage quarters{pixels.quarters};
        QuarterParts parts{links, linear, quarters};
        EXPECT_EQ(parts.shares(0, 0).others[kEdgeShareChannel][0], 0U);
        EXPECT_EQ(parts.shares(1, 0).others[kEdgeShareChannel][0], static_cast<std::uint32_t>(kLinearOne));
        EXPECT_EQ(parts.shares(1, 0).others[1][0], 0U);
        parts.join_for_lattice();
        return quarters.row(0, 1)[2];
    }
};

TEST(QuarterParts, WhatLiesBehindASurfaceShowsInItAndWhatIsBeforeItDoesNot) {
    EXPECT_EQ(TwoPixels{0.5F}.joined(), 0);
    EXPECT_EQ(TwoPixels{0.01F}.joined(), kLinearOne);
}

}  // namespace
}  // namespace lw::test
