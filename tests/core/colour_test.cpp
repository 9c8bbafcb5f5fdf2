#include "core/colour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lw {
namespace {

TEST(Colour, EveryStoredValueRoundTrips) {
    for (int value = 0; value < 256; ++value) {
        const float linear = linear_from_srgb8_table()[static_cast<std::size_t>(value)];
        EXPECT_EQ(srgb8_from_linear(linear), value);
    }
}

TEST(Colour, EncodesToTheNearestStoredValue) {
    for (int step = 0; step <= 100000; ++step) {
        const auto linear = static_cast<float>(step / 100000.0);
        const double exact = 255.0 * srgb_from_linear(static_cast<double>(linear));
        // 1e-4: a float halfway between two values may belong to either.
        ASSERT_LE(std::abs(srgb8_from_linear(linear) - exact), 0.5 + 1e-4) << "linear " << linear;
    }
}

TEST(Colour, KnownValuesOfTheStandard) {
    EXPECT_DOUBLE_EQ(linear_from_srgb(0.0), 0.0);
    EXPECT_NEAR(linear_from_srgb(1.0), 1.0, 1e-15);
    EXPECT_NEAR(linear_from_srgb(0.04045), 0.04045 / 12.92, 1e-15);
    EXPECT_NEAR(linear_from_srgb(0.5), 0.21404114, 1e-8);
    EXPECT_NEAR(srgb_from_linear(0.5), 0.73535698, 1e-8);
}

TEST(Colour, OutOfRangeAndNanAreClamped) {
    EXPECT_EQ(srgb8_from_linear(-1.0F), 0);
    EXPECT_EQ(srgb8_from_linear(2.0F), 255);
    EXPECT_EQ(srgb8_from_linear(std::numeric_limits<float>::infinity()), 255);
    EXPECT_EQ(srgb8_from_linear(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Colour, WholeColoursGoThroughTheSameTable) {
    const Rgba8 colour{12, 128, 250, 255};
    EXPECT_EQ(srgb8_of(linear_of(colour)), colour);
}

}  // namespace
}  // namespace lw
