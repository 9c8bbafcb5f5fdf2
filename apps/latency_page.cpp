#include "apps/latency_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/html_report.h"
#include "apps/live_report.h"
#include "apps/live_timeline.h"

namespace lw {
namespace {

std::vector<double> over(const std::vector<SeenRefresh>& refreshes, Duration SeenRefresh::*what) {
    std::vector<double> ms;
    for (const SeenRefresh& refresh : refreshes) {
        if (refresh.injected == Injected::nothing) ms.push_back(to_ms(refresh.*what));
    }
    return ms;
}

SvgPlot latencies_over_time(const LatencyHarness& harness) {
    SvgPlot plot{"Latency of every refresh", "time, s", "ms"};
    SvgSeries motion{"motion to photon", {}, {}, SvgMarks::line};
    SvgSeries age{"frame age", {}, {}, SvgMarks::line};
    for (const SeenRefresh& refresh : harness.refreshes) {
        const double time_s = to_seconds(refresh.photon - harness.refreshes.front().photon);
        motion.x.push_back(time_s);
        motion.y.push_back(to_ms(refresh.motion_to_photon));
        age.x.push_back(time_s);
        age.y.push_back(to_ms(refresh.frame_age));
    }
    plot.y_from_zero = true;
    plot.series = {motion, age};
    return plot;
}

}  // namespace

SvgPlot histogram_of(const std::string& title, const std::string& x_label, const std::vector<double>& values) {
    SvgPlot plot{title, x_label, "% of all"};
    plot.height_px = 240.0;
    plot.y_from_zero = true;
    const auto spread = distribution_of(values);
    if (!spread) return plot;
    constexpr int kBins = 60;
    // The tail beyond p99 has one bin at the end.
    const double low = spread->min;
    const double width = std::max((spread->p99 - low) * 1.1 / kBins, 1e-6);
    std::vector<double> counts(kBins + 1);
    for (const double value : values) {
        const auto bin = static_cast<std::size_t>(std::clamp((value - low) / width, 0.0, static_cast<double>(kBins)));
        counts[bin] += 100.0 / static_cast<double>(values.size());
    }
    SvgSeries outline{"", {}, {}, SvgMarks::line};
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        for (const std::size_t edge : {bin, bin + 1}) {
            outline.x.push_back(low + static_cast<double>(edge) * width);
            outline.y.push_back(counts[bin]);
        }
    }
    plot.series = {outline};
    return plot;
}

std::string latency_page(const Options& options, const LiveResult& result, const LatencyHarness& harness) {
    HtmlReport page{fmt::format("Latewarp: latency of {}", options.scene)};
    page.add_paragraph(live_summary_text(options, result));
    if (!harness.suspect.empty()) page.add_paragraph("SUSPECT: " + harness.suspect);
    page.add_paragraph(
        fmt::format("{} codes read from the display, {} bad; {:.2f} % of the refreshes show the picture "
                    "that the server meant them to.",
                    harness.codes_read, harness.codes_bad, 100.0 * harness.in_phase_share));
    page.add_lanes(timeline_of(result, from_ms(250.0)));
    page.add_plot(latencies_over_time(harness));
    page.add_plot(histogram_of("Motion to photon", "ms", over(harness.refreshes, &SeenRefresh::motion_to_photon)));
    page.add_plot(histogram_of("Frame age", "ms", over(harness.refreshes, &SeenRefresh::frame_age)));
    std::vector<double> warp_ms;
    for (const Duration time : result.warp_times) warp_ms.push_back(to_ms(time));
    std::vector<double> late_ms;
    for (const DisplayRecord& part : result.parts) {
        if (!part.presented) continue;
        late_ms.push_back(to_ms(part.latched - part.planned_wake));
    }
    page.add_plot(histogram_of("Warp of a refresh", "ms", warp_ms));
    page.add_plot(histogram_of("Lateness of the wake-up", "ms", late_ms));
    return page.text();
}

}  // namespace lw
