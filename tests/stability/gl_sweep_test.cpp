/// The random cases on the GL methods.

#include <gtest/gtest.h>

#include <iostream>

#include "apps/stability/sweep.h"
#include "tests/support/gl_test.h"

namespace lw::stability {
namespace {

// Twice and a half what the CPU methods may: a rasteriser snaps places to 1/256 of a pixel.
constexpr double kPlaceBound_px = 0.05;
constexpr double kDepthBound = 1e-5;

TEST(GlSweeps, EveryGlMethodKeepsItsBounds) {
    LW_NEED_GL();
    auto sweep =
        Sweep::create({"points:size_px=0", "compute", "mesh", "inverse-gl", "surface-gl"}, CaseRange::promised);
    ASSERT_TRUE(sweep.ok());
    for (std::uint64_t seed = 0; seed < 200; ++seed) sweep->run(seed);
    for (const MethodReport& report : sweep->reports()) {
        std::cout << summary_of(report) << '\n';
        EXPECT_LE(report.errors.place_px.value, kPlaceBound_px) << report.method;
        // A vertex snapped to 1/256 of a pixel takes its depth along.
        if (report.method != "mesh") {
            EXPECT_LE(report.errors.depth.value, kDepthBound) << report.method;
        }
        EXPECT_EQ(report.errors.faults(), 0U) << report.method;
    }
}

}  // namespace
}  // namespace lw::stability
