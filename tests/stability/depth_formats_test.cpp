#include "apps/stability/depth_formats.h"

#include <gtest/gtest.h>

namespace lw::stability {
namespace {

constexpr double kNear_m = 0.05;

TEST(DepthFormats, TheErrorIsWhatTheStepPredicts) {
    for (const DepthFormat format : depth_formats()) {
        for (const double distance_m : {0.1, 1.0, 10.0, 1e3, 1e5, 1e7}) {
            const DepthError error = measure_depth_error(format, distance_m, kNear_m);
            EXPECT_LE(error.relative, error.predicted_relative * (1.0 + 1e-9)) << name_of(format) << distance_m;
            // 4000 samples come within a fifth of the worst, unless all of the range rounds to one value.
            EXPECT_GE(error.relative, 0.8 * error.predicted_relative) << name_of(format) << " " << distance_m;
        }
    }
}

TEST(DepthFormats, OnlyOursKeepsItsDigitsAtAnyDistance) {
    for (const double distance_m : {0.1, 1.0, 1e3, 1e7}) {
        // 2^-24: half a step of a float with 24 bits.
        EXPECT_LE(measure_depth_error(DepthFormat::float32_reversed, distance_m, kNear_m).relative, 0x1p-24);
    }
    EXPECT_EQ(measure_depth_error(DepthFormat::unorm24_reversed, 1e7, kNear_m).relative, 1.0);
    EXPECT_EQ(measure_depth_error(DepthFormat::unorm16_forward, 1e5, kNear_m).relative, 1.0);
    EXPECT_EQ(measure_depth_error(DepthFormat::float32_forward, 1e7, kNear_m).relative, 1.0);
}

}  // namespace
}  // namespace lw::stability
