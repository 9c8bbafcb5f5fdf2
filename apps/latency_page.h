#pragma once
/// The pictures of a measurement: what each thread did when, latencies over time, and how they are distributed.

#include <string>
#include <vector>

#include "apps/latency_harness.h"
#include "apps/svg_plot.h"

namespace lw {

/// What each thread did during at least `span` in the middle of the run, while one frame is drawn and first shown: the
/// client draws, the server waits, warps and presents, the display scans out; and the life of one rendered frame from
/// its head sample to the photons. Pure.
[[nodiscard]] SvgPlot timeline_of(const LiveResult& result, Duration span);

/// Shares of the values in bins of equal width, as an outline. Pure.
[[nodiscard]] SvgPlot histogram_of(const std::string& title, const std::string& x_label,
                                   const std::vector<double>& values);

/// The whole page, self-contained. Pure.
[[nodiscard]] std::string latency_page(const Options& options, const LiveResult& result, const LatencyHarness& harness);

}  // namespace lw
