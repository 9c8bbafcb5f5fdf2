#include "core/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/image_io.h"
#include "tests/support/shared_data.h"

namespace lw {
namespace {

ColourImage noise(glm::ivec2 size_px, std::uint32_t seed) {
    ColourImage image{size_px};
    for (Rgba8& pixel : image.pixels()) {
        seed = seed * 1664525U + 1013904223U;
        pixel = {static_cast<std::uint8_t>(seed >> 24U), static_cast<std::uint8_t>(seed >> 16U),
                 static_cast<std::uint8_t>(seed >> 8U), 255};
    }
    return image;
}

double luma(Rgba8 c) { return (0.299 * c.r + 0.587 * c.g + 0.114 * c.b) / 255.0; }

// The definition written down: one two-dimensional window per pixel, double precision.
double slow_ssim(const ColourImage& a, const ColourImage& b) {
    constexpr int kRadius = 5;
    double weights[11][11];
    double total = 0.0;
    for (int j = -kRadius; j <= kRadius; ++j) {
        for (int i = -kRadius; i <= kRadius; ++i) {
            weights[j + kRadius][i + kRadius] = std::exp(-(i * i + j * j) / (2.0 * 1.5 * 1.5));
            total += weights[j + kRadius][i + kRadius];
        }
    }
    double sum = 0.0;
    int count = 0;
    for (int y = kRadius; y < a.height() - kRadius; ++y) {
        for (int x = kRadius; x < a.width() - kRadius; ++x) {
            double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = -kRadius; j <= kRadius; ++j) {
                for (int i = -kRadius; i <= kRadius; ++i) {
                    const double w = weights[j + kRadius][i + kRadius] / total;
                    const double la = luma(a.at(x + i, y + j));
                    const double lb = luma(b.at(x + i, y + j));
                    ma += w * la;
                    mb += w * lb;
                    aa += w * la * la;
                    bb += w * lb * lb;
                    ab += w * la * lb;
                }
            }
            const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
            sum += (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
                   ((ma * ma + mb * mb + c1) * (aa - ma * ma + bb - mb * mb + c2));
            ++count;
        }
    }
    return sum / count;
}

TEST(Psnr, EqualImagesHaveNone) {
    const ColourImage image = noise({8, 8}, 1);
    EXPECT_FALSE(psnr_db(image, image));
}

TEST(Psnr, HandComputed) {
    ColourImage a{{2, 1}};
    ColourImage b = a;
    b.at(1, 0) = {3, 0, 4, 0};  // alpha is ignored
    EXPECT_NEAR(*psnr_db(a, b), 10.0 * std::log10(255.0 * 255.0 / (25.0 / 6.0)), 1e-12);
    for (Rgba8& pixel : b.pixels()) pixel = {255, 255, 255, 255};
    EXPECT_NEAR(*psnr_db(a, b), 0.0, 1e-12);
}

TEST(Ssim, EqualImagesGiveExactlyOne) {
    const ColourImage image = noise({40, 30}, 2);
    EXPECT_EQ(ssim(image, image), 1.0);
}

TEST(Ssim, FlatImagesAreComparedByTheirLuminanceOnly) {
    const ColourImage a{{16, 16}, Rgba8{51, 51, 51, 255}};
    const ColourImage b{{16, 16}, Rgba8{102, 102, 102, 255}};
    const double c1 = 1e-4;
    // 5e-5: single-precision windows leave a variance of some 2e-8, against 9e-4 in the denominator.
    EXPECT_NEAR(ssim(a, b), (2 * 0.2 * 0.4 + c1) / (0.04 + 0.16 + c1), 5e-5);
}

TEST(Ssim, AgreesWithTheDefinition) {
    ColourImage a = noise({37, 29}, 3);
    ColourImage b = a;
    const ColourImage other = noise({37, 29}, 4);
    for (int y = 0; y < 29; ++y) {
        for (int x = 10; x < 20; ++x) b.at(x, y) = other.at(x, y);
    }
    // 1e-5: single-precision windows.
    EXPECT_NEAR(ssim(a, b), slow_ssim(a, b), 1e-5);
}

TEST(Ssim, ImagesBelowTheWindowAreStillCompared) {
    const ColourImage a{{3, 1}, Rgba8{0, 0, 0, 255}};
    const ColourImage b{{3, 1}, Rgba8{255, 255, 255, 255}};
    EXPECT_NEAR(ssim(a, b), 1e-4 / (1.0 + 1e-4), 1e-5);
    EXPECT_EQ(ssim(a, a), 1.0);
}

TEST(Flip, EqualImagesGiveZeroEverywhere) {
    const ColourImage image = noise({32, 32}, 5);
    const FlipResult result = flip(image, image, 8.9);
    EXPECT_EQ(result.mean, 0.0);
    for (const float error : result.error_map.pixels()) ASSERT_EQ(error, 0.0F);
}

TEST(Flip, IsSymmetricForFlatImagesAndNearOneForBlackAndWhite) {
    const ColourImage black{{16, 16}, Rgba8{0, 0, 0, 255}};
    const ColourImage white{{16, 16}, Rgba8{255, 255, 255, 255}};
    const double forward = flip(black, white, 20.0).mean;
    EXPECT_EQ(forward, flip(white, black, 20.0).mean);
    // Distance 100 in lightness; the largest is that from green, Lab (87.73, -86.18, 83.18), to blue (32.30, 79.19,
    // -107.86), each with its chroma scaled by its lightness: 55.43 + hypot(101.2, 107.8) = 203.3. Both to the power
    // 0.7, then the upper piece of the map. No features in flat images. 1e-4: the rounded values above.
    const double largest = std::pow(203.3, 0.7);
    EXPECT_NEAR(forward, 0.95 + (std::pow(100.0, 0.7) - 0.4 * largest) / (0.6 * largest) * 0.05, 1e-4);
}

TEST(Flip, GrowsWithTheDifference) {
    const ColourImage grey{{16, 16}, Rgba8{100, 100, 100, 255}};
    double last = 0.0;
    for (const int value : {101, 105, 120, 180, 255}) {
        const auto v = static_cast<std::uint8_t>(value);
        const double error = flip(grey, ColourImage{{16, 16}, Rgba8{v, v, v, 255}}, 8.9).mean;
        EXPECT_GT(error, last);
        last = error;
    }
    EXPECT_LT(last, 1.0);
}

TEST(Flip, FineDetailVanishesWithDistance) {
    ColourImage checkers{{64, 64}};
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            if ((x + y) % 2 == 0) checkers.at(x, y) = {255, 255, 255, 255};
        }
    }
    const ColourImage mean{{64, 64}, Rgba8{188, 188, 188, 255}};  // half the light of white
    const double close_by = flip(mean, checkers, 9.0).mean;
    EXPECT_GT(close_by, 0.8);
    EXPECT_LT(flip(mean, checkers, 120.0).mean, 0.5 * close_by);
}

TEST(DataFlip, AgreesWithTheReferenceImplementation) {
    LW_NEED_SHARED_DATA();
    const auto folder = test::shared_data_dir() / "flip";
    const auto reference = read_png(folder / "tree-ref.png");
    const auto test_image = read_png(folder / "tree-test.png");
    const auto magma_map = read_png(folder / "tree-comparison-cli.png");
    ASSERT_TRUE(reference && test_image && magma_map);
    const FlipResult result = flip(*reference, *test_image, 67.0);
    // The reference's own mean at 67 pixels per degree. 1e-3 allows for its colour matrices and single precision.
    EXPECT_NEAR(result.mean, 0.133285, 1e-3);
    EXPECT_NEAR(*std::max_element(result.error_map.pixels().begin(), result.error_map.pixels().end()), 0.983044, 2e-3);

    // Its map is coloured; the colours' luma rises with the error, so the two must order pixels alike: correlate them.
    double sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    const auto count = static_cast<double>(result.error_map.pixels().size());
    ASSERT_EQ(magma_map->size_px(), result.error_map.size_px());
    for (std::size_t i = 0; i < result.error_map.pixels().size(); ++i) {
        const double a = static_cast<double>(result.error_map.pixels()[i]);
        const double b = luma(magma_map->pixels()[i]);
        sa += a;
        sb += b;
        saa += a * a;
        sbb += b * b;
        sab += a * b;
    }
    const double correlation = (sab - sa * sb / count) / std::sqrt((saa - sa * sa / count) * (sbb - sb * sb / count));
    // Not 1, since luma along that palette is not quite linear.
    EXPECT_GT(correlation, 0.99);
}

TEST(MetricsDeathTest, SizesMustMatch) {
    const ColourImage a{{4, 4}};
    const ColourImage b{{4, 5}};
    EXPECT_DEATH((void)psnr_db(a, b), "4x4 against 4x5");
    EXPECT_DEATH((void)ssim(a, b), "4x4 against 4x5");
    EXPECT_DEATH((void)flip(a, b, 67.0), "4x4 against 4x5");
}

}  // namespace
}  // namespace lw
