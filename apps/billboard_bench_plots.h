#pragma once
/// The plots of the suite `billboards`.

#include <string>
#include <utility>
#include <vector>

#include "apps/billboard_bench_runs.h"
#include "apps/svg_plot.h"

namespace lw {

/// By the names of their files. `bench` has a path with trials. Pure.
[[nodiscard]] std::vector<std::pair<std::string, SvgPlot>> plots_of(const BillboardBench& bench);

}  // namespace lw
