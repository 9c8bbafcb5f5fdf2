/// What `surface` makes of pixels whose quarters it knows.

#include "warp_server/methods/surface_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/colour.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/image_assertions.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

// A wall 1 m away whose quarters are black and white stripes of a quarter's width, each as wide as half a pixel: so
// every pixel is their mean.
Layer striped_wall(const Camera& source) {
    Layer layer = indexed_layer(source, 0.05F);
    CpuPixels& pixels = layer.cpu();
    const std::uint8_t grey = srgb8_from_linear(0.5F);
    for (Rgba8& colour : pixels.colour.pixels()) colour = {grey, grey, grey, 255};
    pixels.alpha_is_share = true;
    pixels.quarters = ColourImage{2 * source.size_px};
    for (int y = 0; y < pixels.quarters.height(); ++y) {
        for (int x = 0; x < pixels.quarters.width(); ++x) {
            const std::uint8_t level = x % 2 == 0 ? 0 : 255;
            pixels.quarters.at(x, y) = {level, level, level, 255};
        }
    }
    return layer;
}

// The quarters of a picture of waves that are few pixels long, and the pixels that are their means.
void draw_waves(Layer& layer, double wave_px) {
    CpuPixels& pixels = layer.cpu();
    pixels.quarters = ColourImage{2 * layer.camera.size_px};
    const auto level_at = [&](double x_px) { return 0.5 + 0.4 * std::sin(2.0 * 3.141592653589793 * x_px / wave_px); };
    const auto grey = [](double linear) {
        const std::uint8_t level = srgb8_from_linear(static_cast<float>(linear));
        return Rgba8{level, level, level, 255};
    };
    for (int y = 0; y < pixels.quarters.height(); ++y) {
        for (int x = 0; x < pixels.quarters.width(); ++x) pixels.quarters.at(x, y) = grey(level_at(0.5 * x + 0.25));
    }
    for (int y = 0; y < pixels.colour.height(); ++y) {
        for (int x = 0; x < pixels.colour.width(); ++x) {
            pixels.colour.at(x, y) = grey(0.5 * (level_at(x + 0.25) + level_at(x + 0.75)));
        }
    }
}

Camera shifted(const Camera& source, glm::dvec2 shift_px) {
    Camera target = source;
    const double tan_per_px = (source.fov.right - source.fov.left) / source.size_px.x;
    target.fov.left += shift_px.x * tan_per_px;
    target.fov.right += shift_px.x * tan_per_px;
    target.fov.up -= shift_px.y * tan_per_px;
    target.fov.down -= shift_px.y * tan_per_px;
    return target;
}

TEST(SurfaceLattice, HoldsPixelsAtTheirCentresAndMeansOfTheirQuartersBetween) {
    std::mt19937 random{3};
    ColourImage colour{{3, 2}};
    ColourImage quarters{{6, 4}};
    const auto fill = [&](ColourImage& image) {
        for (Rgba8& pixel : image.pixels()) pixel = colour_of_index(random() & 0xFFFFFFU);
    };
    fill(colour);
    fill(quarters);
    const LinearImage pixels{colour};
    const LinearImage fine{quarters};
    const ColourLattice lattice{pixels, LinearImage{quarters}, 1};
    ASSERT_EQ(lattice.size(), glm::ivec2(6, 4));
    for (int channel = 0; channel < 3; ++channel) {
        for (int y = 0; y < 4; ++y) {
            for (int x = 0; x < 6; ++x) {
                const int right = std::min(x + 1, 5);
                const int below = std::min(y + 1, 3);
                const int sum = fine.row(y, channel)[x] + fine.row(y, channel)[right] + fine.row(below, channel)[x] +
                                fine.row(below, channel)[right];
                const bool is_pixel = x % 2 == 0 && y % 2 == 0;
                const int value = lattice.node(x, y)[channel];
                if (is_pixel) {
                    EXPECT_EQ(value, pixels.row(y / 2, channel)[x / 2]) << x << ", " << y;
                } else {  // a mean of two means, each rounded up
                    EXPECT_NEAR(value, 0.25 * sum, 1.0) << x << ", " << y;
                }
            }
        }
    }
}

TEST(SurfaceLattice, RepeatsItsOutermostNodesAroundIt) {
    const LinearImage pixels{ColourImage{{3, 2}, {10, 20, 30, 255}}};
    ColourImage quarters{{6, 4}};
    for (std::size_t i = 0; i < quarters.pixels().size(); ++i)
        quarters.pixels()[i].g = static_cast<std::uint8_t>(9 * i);
    const ColourLattice lattice{pixels, LinearImage{quarters}, 1};
    for (int y = -1; y < 4 + 2; ++y) {
        for (int x = -1; x < 6 + 2; ++x) {
            const std::uint16_t* inside = lattice.node(std::clamp(x, 0, 5), std::clamp(y, 0, 3));
            for (int channel = 0; channel < ColourLattice::kChannels; ++channel) {
                EXPECT_EQ(lattice.node(x, y)[channel], inside[channel]) << x << ", " << y;
            }
        }
    }
}

TEST(SurfaceLattice, AStillPictureIsTheSource) {
    const Camera source = street_camera({40, 24});
    const Layer layer = striped_wall(source);
    const DisplayFrame frame = warp_once("surface", layer, {source, {}});
    EXPECT_EQ(frame.colour, layer.cpu().colour);
}

TEST(SurfaceLattice, AWholePixelFurtherIsTheSourceToo) {
    const Camera source = street_camera({40, 24});
    Layer layer = indexed_layer(source, 0.05F);
    draw_waves(layer, 2.7);
    const DisplayFrame frame = warp_once("surface", layer, {shifted(source, {1.0, 0.0}), {}});
    for (int y = 0; y < 24; ++y) {
        // Places a millionth of a pixel beside the centres round to neighbouring levels.
        for (int x = 0; x < 39; ++x) ASSERT_NEAR(frame.colour.at(x, y).g, layer.cpu().colour.at(x + 1, y).g, 1) << x;
    }
}

TEST(SurfaceLattice, HalfAPixelFurtherShowsTheQuartersThere) {
    // Each pixel half a pixel further is one black and one white half again; so is one at any place between.
    const Camera source = street_camera({40, 24});
    const Layer layer = striped_wall(source);
    for (const double shift_px : {0.25, 0.5, 0.8}) {
        const DisplayFrame frame = warp_once("surface", layer, {shifted(source, {shift_px, 0.0}), {}});
        for (int x = 1; x < 38; ++x) EXPECT_NEAR(frame.colour.at(x, 12).g, srgb8_from_linear(0.5F), 1) << x;
    }
}

TEST(SurfaceLattice, FineWavesKeepMoreOfTheirHeightThanFromPixelsAlone) {
    constexpr double kWavePx = 3.0;
    const Camera source = street_camera({60, 24});
    Layer layer = indexed_layer(source, 0.05F);
    draw_waves(layer, kWavePx);
    const auto error_of = [&](double shift_px) {
        const DisplayFrame frame = warp_once("surface", layer, {shifted(source, {shift_px, 0.0}), {}});
        Layer exact = indexed_layer(source, 0.05F);
        double worst = 0.0;
        for (int x = 2; x < 57; ++x) {
            // The mean over a pixel of the wave, exactly.
            const double k = 2.0 * 3.141592653589793 / kWavePx;
            const double centre = x + 0.5 + shift_px;
            const double mean = 0.5 + 0.4 * std::sin(k * centre) * std::sin(0.5 * k) / (0.5 * k);
            worst = std::max(worst, std::abs(linear_of(frame.colour.at(x, 12)).g - mean));
        }
        return worst;
    };
    // Two quarters instead of a whole pixel's mean make the wave 15 % too high at its centres, by definition of the
    // source; half a pixel beside them a mean of two pixels would lose half of it, 0.17.
    const double at_centres = error_of(1.0);
    EXPECT_LT(error_of(0.5), at_centres + 0.01);
    layer.cpu().quarters = {};
    EXPECT_GT(error_of(0.5), 2.0 * at_centres);
}

// The largest error of waves shown a part of a pixel further, against their mean over each pixel, which is linear.
double worst_of_waves(const Layer& layer, double wave_px, double shift_px) {
    const DisplayFrame frame = warp_once("surface", layer, {shifted(layer.camera, {shift_px, 0.0}), {}});
    double worst = 0.0;
    for (int x = 4; x < layer.camera.size_px.x - 5; ++x) {
        const double k = 2.0 * 3.141592653589793 / wave_px;
        const double mean = 0.5 + 0.4 * std::sin(k * (x + 0.5 + shift_px)) * std::sin(0.5 * k) / (0.5 * k);
        worst = std::max(worst, std::abs(linear_of(frame.colour.at(x, 12)).g - mean));
    }
    return worst;
}

TEST(SurfaceLattice, QuartersOfSeveralSamplesAreReadAlongACurve) {
    constexpr double kWavePx = 4.0;
    Layer layer = indexed_layer(street_camera({60, 24}), 0.05F);
    CpuPixels& pixels = layer.cpu();
    // Means over quarters and pixels, as of many samples.
    draw_waves(layer, kWavePx);
    const double k = 2.0 * 3.141592653589793 / kWavePx;
    const auto mean_level = [&](double centre_px, double width_px) {
        const double level = 0.5 + 0.4 * std::sin(k * centre_px) * std::sin(0.5 * k * width_px) / (0.5 * k * width_px);
        const std::uint8_t grey = srgb8_from_linear(static_cast<float>(level));
        return Rgba8{grey, grey, grey, 255};
    };
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 120; ++x) pixels.quarters.at(x, y) = mean_level(0.5 * x + 0.25, 0.5);
    }
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 60; ++x) pixels.colour.at(x, y) = mean_level(x + 0.5, 1.0);
    }
    pixels.quarter_samples = 1;
    const double straight = worst_of_waves(layer, kWavePx, 0.25);
    pixels.quarter_samples = 4;
    EXPECT_LT(worst_of_waves(layer, kWavePx, 0.25), 0.6 * straight);
    // On the nodes both are exact, up to rounding to levels.
    EXPECT_LT(worst_of_waves(layer, kWavePx, 0.5), 0.01);
}

TEST(SurfaceLattice, ACurveDoesNotLeaveTheNodesItLiesBetween) {
    // White on the right of an edge between two pixels: nothing darker than black or lighter than white may ring.
    const Camera source = street_camera({40, 24});
    Layer layer = indexed_layer(source, 0.05F);
    CpuPixels& pixels = layer.cpu();
    constexpr Rgba8 kDark{60, 60, 60, 255};
    constexpr Rgba8 kLight{200, 200, 200, 255};
    pixels.quarters = ColourImage{2 * source.size_px};
    pixels.quarter_samples = 4;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 80; ++x) pixels.quarters.at(x, y) = x < 40 ? kDark : kLight;
    }
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 40; ++x) pixels.colour.at(x, y) = x < 20 ? kDark : kLight;
    }
    for (const double shift_px : {0.1, 0.25, 0.6, 0.9}) {
        const DisplayFrame frame = warp_once("surface", layer, {shifted(source, {shift_px, 0.0}), {}});
        for (int x = 0; x < 39; ++x) {
            EXPECT_GE(frame.colour.at(x, 12).g, kDark.g) << x << ", " << shift_px;
            EXPECT_LE(frame.colour.at(x, 12).g, kLight.g) << x << ", " << shift_px;
            EXPECT_GE(frame.colour.at(x, 12).g, frame.colour.at(std::max(x - 1, 0), 12).g) << x << ", " << shift_px;
        }
    }
}

TEST(SurfaceLattice, ASourceTwiceAsDenseIsReadByItsPixels) {
    const Camera source = street_camera({80, 48});
    Camera target = shifted(source, {0.6, 0.3});
    target.size_px = {40, 24};
    Layer layer = striped_wall(source);
    const DisplayFrame with_quarters = warp_once("surface", layer, {target, {}});
    layer.cpu().quarters = {};
    EXPECT_EQ(with_quarters.colour, warp_once("surface", layer, {target, {}}).colour);
}

}  // namespace
}  // namespace lw::test
