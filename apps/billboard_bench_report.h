#pragma once
/// The suite `billboards` as JSON, CSV, plots and a page.

#include <optional>
#include <span>

#include "apps/bench_suites.h"
#include "apps/billboard_bench_runs.h"

namespace lw {

/// The figures that the whole suite comes down to.
struct BillboardFigures {
    double speedup_best_100 = 0.0;      ///< least speed-up of the best hundred frames (of all, where there are fewer)
    double speedup_min_eligible = 0.0;  ///< over frames with 80 % of the triangles replaceable and 64 redraws at most
    std::size_t eligible = 0;
    double ssim_mean = 1.0;
    double ssim_min = 1.0;
    double warped_better = 0.0;    ///< share of the frames in which warped quads beat flat ones, updated as often
    double flicker_ratio = 0.0;    ///< with cross-fade to without, warped
    double redraw_ratio = 0.0;     ///< redraws of warped to flat ones at equal FLIP
    double worst_to_median = 0.0;  ///< frame time of ours: largest share of updates above the median frame
};

/// Pure.
[[nodiscard]] BillboardFigures figures_of(const BillboardBench& bench);

/// Redraws per frame that reach `flip`, by linear interpolation between the points of one curve in order of their
/// redraws; nothing outside of it. Pure.
[[nodiscard]] std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip);

[[nodiscard]] BenchOutput output_of(const BillboardBench& bench, const scene::Scene& scene);

}  // namespace lw
