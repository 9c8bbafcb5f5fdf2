#include "core/error_attribution.h"

#include <gtest/gtest.h>

#include "core/metrics.h"
#include "tests/core/card_scene.h"

namespace lw::test {
namespace {

// A texture that is the same wherever it is drawn: light and dark by the pixel, on top of `level`.
ColourImage checkered(glm::ivec2 size_px, int level, int amplitude) {
    ColourImage colour{size_px};
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            const auto value = static_cast<std::uint8_t>(level + ((x + y) % 2 == 0 ? amplitude : -amplitude));
            colour.at(x, y) = {value, value, value, 255};
        }
    }
    return colour;
}

Image<ErrorCause> causes(const CardPicture& truth, const ColourImage& truth_colour, const CardPicture& source,
                         const ColourImage& source_colour) {
    return error_causes(truth.view(), truth_colour, source.view(), source_colour, 1);
}

TEST(ErrorAttribution, SortsPixelsByWhatTheSourceKnew) {
    // As in SurfaceMatch.TellsHiddenSurfacesFromSeenOnes: columns 36..38 are uncovered, column 63 comes into view.
    const CardPicture source = draw_cards({}, card_camera(0.0));
    const CardPicture truth = draw_cards({}, card_camera(0.25));
    const ColourImage grey = checkered({64, 64}, 100, 0);
    const Image<ErrorCause> found = causes(truth, grey, source, grey);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const ErrorCause expected = x == 63              ? ErrorCause::out_of_frame
                                        : x >= 36 && x <= 38 ? ErrorCause::disoccluded
                                                             : ErrorCause::resampled;
            ASSERT_EQ(found.at(x, y), expected) << x << " " << y;
        }
    }
    EXPECT_DOUBLE_EQ(shares_of(found).disoccluded, 3.0 / 64.0);
    EXPECT_DOUBLE_EQ(shares_of(found).out_of_frame, 1.0 / 64.0);
    EXPECT_DOUBLE_EQ(shares_of(found).sum(), 1.0);
}

TEST(ErrorAttribution, ALightThatChangedIsStaleShadingOnItsSurfaceOnly) {
    const CardPicture picture = draw_cards({}, card_camera(0.0));
    ColourImage truth_colour = checkered({64, 64}, 100, 0);
    const ColourImage source_colour = truth_colour;
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            if (picture.is_card(x, y)) truth_colour.at(x, y) = {110, 100, 100, 255};
        }
    }
    const Image<ErrorCause> found = causes(picture, truth_colour, picture, source_colour);
    for (int y = 0; y < 64; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool stale = picture.is_card(x, y);
            ASSERT_EQ(found.at(x, y), stale ? ErrorCause::stale_shading : ErrorCause::resampled) << x << " " << y;
        }
    }
}

TEST(ErrorAttribution, AliasingIsNotTakenForStaleShading) {
    // The truth's texture is fine; the source, half a pixel beside, reads the mean of neighbouring pixels.
    const CardPicture source = draw_cards({}, card_camera(0.0));
    const CardPicture truth = draw_cards({}, card_camera(0.15625));  // the wall moves by half a pixel
    const Image<ErrorCause> found = causes(truth, checkered({64, 64}, 100, 20), source, checkered({64, 64}, 100, 20));
    EXPECT_EQ(shares_of(found).stale_shading, 0.0);
}

TEST(ErrorAttribution, PartsSumToTheWhole) {
    const CardPicture source = draw_cards({}, card_camera(0.0));
    const CardPicture truth = draw_cards({}, card_camera(0.25));
    const ColourImage truth_colour = checkered({64, 64}, 100, 30);
    ColourImage source_colour = checkered({64, 64}, 100, 30);
    for (int x = 0; x < 20; ++x) source_colour.at(x, 10) = {200, 40, 40, 255};
    const FlipResult error = flip(truth_colour, source_colour, 8.9);
    const AttributedError parts = attribute_error(error.error_map, causes(truth, truth_colour, source, source_colour));
    EXPECT_GT(parts.resampled, 0.0);
    EXPECT_GT(error.mean, 0.0);
    // The mean is added up in another order.
    EXPECT_NEAR(parts.sum(), error.mean, 1e-6);
}

}  // namespace
}  // namespace lw::test
