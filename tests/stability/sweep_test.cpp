/// Random cases over every axis: every method places its samples where the exact reprojection says. A case that fails
/// is seen again with `latewarp bench --suite stability --case SEED`.

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "apps/stability/sweep.h"
#include "core/reprojection.h"

namespace lw::stability {
namespace {

// What docs/accuracy.md promises.
constexpr double kPlaceBound_px = 0.02;
constexpr double kDepthBound = 1e-5;

void expect_within_bounds(const MethodReport& report) {
    std::cout << summary_of(report) << '\n';
    const MethodErrors& errors = report.errors;
    EXPECT_LE(errors.place_px.value, kPlaceBound_px) << report.method << ", case " << errors.place_px.seed;
    EXPECT_LE(errors.depth.value, kDepthBound) << report.method << ", case " << errors.depth.seed;
    EXPECT_EQ(errors.faults() - errors.invented, 0U) << report.method << ", case " << errors.first_fault.seed;
    // Three unrelated depths in a row agree by chance with one slope in about one case of ten thousand, each of which
    // has some hundred pixels along edges; `surface` then takes two surfaces for one and stretches a cell between them.
    const std::uint64_t by_chance = report.method == "surface" ? errors.cases / 2000 : 0;
    EXPECT_LE(errors.invented == 0 ? 0 : errors.faulty_cases, by_chance)
        << report.method << ", case " << errors.first_fault.seed;
    EXPECT_GT(errors.pixels, errors.cases) << "nothing was compared";
}

void sweep_cases(std::uint64_t first, std::uint64_t count) {
    auto sweep = Sweep::create(cpu_methods(), CaseRange::promised);
    ASSERT_TRUE(sweep.ok());
    for (std::uint64_t seed = first; seed < first + count; ++seed) sweep->run(seed);
    for (const MethodReport& report : sweep->reports()) expect_within_bounds(report);
}

// Parts, so that they run side by side and a failure names its part.
class Sweeps : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Of1250, Sweeps, ::testing::Values(0, 1, 2, 3));
TEST_P(Sweeps, EveryCpuMethodKeepsItsBounds) { sweep_cases(GetParam() * 1250, 1250); }

// 100,000 cases in all.
class SlowSweeps : public ::testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Of9500, SlowSweeps, ::testing::Range(std::uint64_t{0}, std::uint64_t{10}));
TEST_P(SlowSweeps, EveryCpuMethodKeepsItsBounds) { sweep_cases(5000 + GetParam() * 9500, 9500); }

// Beyond the promised range errors may be larger; what is shown must still be what is there, and a number.
TEST(BeyondTheRange, PicturesStayPictures) {
    auto sweep = Sweep::create(cpu_methods(), CaseRange::beyond);
    ASSERT_TRUE(sweep.ok());
    for (std::uint64_t seed = 0; seed < 1000; ++seed) sweep->run(seed);
    for (const MethodReport& report : sweep->reports()) {
        std::cout << summary_of(report) << '\n';
        EXPECT_EQ(report.errors.unusable, 0U) << report.method << ", case " << report.errors.first_fault.seed;
    }
}

// The double precision of `reference`, point by point, in all of the promised range.
TEST(ReferencePrecision, DoubleKeepsAThousandthOfAPixel) {
    double worst_px = 0.0;
    std::uint64_t worst_seed = 0;
    std::uint64_t points = 0;
    for (std::uint64_t seed = 0; seed < 20'000; ++seed) {
        const StabilityCase made = make_case(seed, CaseRange::promised);
        ReprojectionTable table;
        table.build(made.source, made.target, made.at_source, made.at_target);
        for (const CaseRegion& region : made.regions) {
            const auto motion = made.motion_of(region.id);
            const ExactReprojection exact{made.source, made.target, motion ? &*motion : nullptr};
            const double x = 0.5 * (region.x0 + region.x1);
            const double y = 0.5 * (region.y0 + region.y1);
            const auto depth = static_cast<double>(region.plane.at(x, y));
            const auto expected = exact.place(x, y, depth);
            const auto* matrix = table.find(region.id);
            ASSERT_NE(matrix, nullptr);
            const auto placed = reproject(*matrix, {x, y}, depth);
            // In the picture, or near it: places beyond are not shown.
            if (!expected || std::abs(expected->position_px.x) > 1e4L || std::abs(expected->position_px.y) > 1e4L)
                continue;
            ASSERT_TRUE(placed) << seed;
            const double error_px = static_cast<double>(std::hypot(expected->position_px.x - placed->position_px.x,
                                                                   expected->position_px.y - placed->position_px.y));
            ++points;
            if (error_px <= worst_px) continue;
            worst_px = error_px;
            worst_seed = seed;
        }
    }
    std::cout << points << " points: " << worst_px << " px, case " << worst_seed << '\n';
    EXPECT_GT(points, 50'000U);
    // A thousandth: a twentieth of what the methods may lose in float on top.
    EXPECT_LE(worst_px, 1e-3);
}

}  // namespace
}  // namespace lw::stability
