#pragma once
/// The suite `billboards` as JSON, CSV, plots and a page.

#include <limits>
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
    double redraw_ratio = 0.0;     ///< redraws of warped to flat ones at the FLIP of flat ones with the default cap
    double flicker_ratio = 0.0;    ///< with cross-fade to without, warped
    double worst_to_median = 0.0;  ///< the median frame with the costliest updates to the median frame, with a budget
};

/// Pure.
[[nodiscard]] BillboardFigures figures_of(const BillboardBench& bench);

/// The fewest redraws per frame with which one curve is as near to the truth as `flip`, by linear interpolation between
/// its points in order of their redraws. Nothing where it never is. Pure.
[[nodiscard]] std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip);

/// A setting of flat billboards and what warped ones need for the same FLIP to the truth.
struct RedrawShare {
    SweepPoint flat;
    std::optional<double> warped_redraws;  ///< per frame; nothing: they do not get as near

    /// Infinite where it is not reached.
    [[nodiscard]] double share() const {
        return warped_redraws ? *warped_redraws / flat.redraws_per_frame : std::numeric_limits<double>::infinity();
    }
};

/// Of all settings of flat billboards. Pure.
[[nodiscard]] std::vector<RedrawShare> redraw_shares(const BillboardBench& bench);

[[nodiscard]] BenchOutput output_of(const BillboardBench& bench, const scene::Scene& scene);

}  // namespace lw
