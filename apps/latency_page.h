#pragma once
/// The page of a measurement: what each thread did when, latencies over time, and how they are distributed.

#include <string>
#include <vector>

#include "apps/latency_harness.h"
#include "apps/svg_plot.h"

namespace lw {

/// Shares of the values in bins of equal width, as an outline. Pure.
[[nodiscard]] SvgPlot histogram_of(const std::string& title, const std::string& x_label,
                                   const std::vector<double>& values);

/// The whole page, self-contained. Pure.
[[nodiscard]] std::string latency_page(const Options& options, const LiveResult& result, const LatencyHarness& harness);

}  // namespace lw
