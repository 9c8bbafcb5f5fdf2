#pragma once
/// The warp suite's plots, tables and CSV, from its points alone. Pure.

#include <string>
#include <utility>
#include <vector>

#include "apps/bench_point.h"
#include "apps/html_report.h"
#include "apps/svg_plot.h"
#include "apps/warp_sweep_plan.h"
#include "apps/warp_sweep_run.h"

namespace lw {

/// Named plots: `front-<conditions>` for every kind of source at the base size and age (run time, logarithmic, against
/// FLIP, the Pareto front as a curve), `age` (FLIP against frame age) and `size` (run time against the display's size).
/// A plot without points is left out.
[[nodiscard]] std::vector<std::pair<std::string, SvgPlot>> warp_sweep_plots(const SweepPlan& plan,
                                                                            const std::vector<BenchPoint>& points,
                                                                            const std::vector<FreshErrors>& fresh);

/// One row per point, mean over its pairs, and one per point and pair.
[[nodiscard]] std::string warp_sweep_csv(const std::vector<BenchPoint>& points);

[[nodiscard]] HtmlReport warp_sweep_page(const SweepPlan& plan, const std::vector<BenchPoint>& points,
                                         const std::vector<std::pair<std::string, SvgPlot>>& plots,
                                         const std::string& machine);

/// Conditions in a few words: "512x512, 100 ms, 2x2 samples, density 1".
[[nodiscard]] std::string text_of(const BenchConditions& conditions);

}  // namespace lw
