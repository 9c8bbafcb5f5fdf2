#include "apps/latency_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/html_report.h"
#include "apps/live_report.h"

namespace lw {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Bars on one row of a time line.
class Row {
public:
    Row(std::string label, double level, TimePoint zero) : zero_{zero}, level_{level} {
        series_.label = std::move(label);
        series_.marks = SvgMarks::line;
    }
    void bar(TimePoint from, TimePoint to) {
        for (const TimePoint time : {from, to}) {
            series_.x.push_back(to_ms(time - zero_));
            series_.y.push_back(level_);
        }
        series_.x.push_back(kNone);
        series_.y.push_back(kNone);
    }
    void tick(TimePoint time, double height) {
        series_.x.insert(series_.x.end(), {to_ms(time - zero_), to_ms(time - zero_), kNone});
        series_.y.insert(series_.y.end(), {level_, level_ + height, kNone});
    }
    [[nodiscard]] SvgSeries series() const { return series_; }

private:
    TimePoint zero_;
    double level_;
    SvgSeries series_;
};

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

SvgPlot timeline_of(const LiveResult& result, Duration span) {
    SvgPlot plot{"What each thread did when", "time, ms", "display 1, server 2-3, client 4, life of a frame 5"};
    plot.height_px = 320.0;
    plot.y_from_zero = true;
    if (result.parts.empty()) return plot;
    // Around the refresh in the middle of the run that was the first to show its frame: the frame's whole life.
    const DisplayRecord* first_shown = &result.parts[result.parts.size() / 2];
    for (std::size_t i = result.parts.size() / 2 + 1; i < result.parts.size(); ++i) {
        const DisplayRecord& part = result.parts[i];
        if (!part.presented || part.frame_index <= result.parts[i - 1].frame_index) continue;
        first_shown = &part;
        break;
    }
    const TimePoint to = first_shown->photon + span / 4;
    const TimePoint from = std::min(first_shown->frame_pose_sampled - span / 20, to - span);
    Row scanout{"scan-out begins", 1.0, from};
    Row waiting{"server waits for its wake-up", 2.0, from};
    Row warping{"warp", 3.0, from};
    Row presenting{"present", 3.0, from};
    Row drawing{"client draws", 4.0, from};
    Row preparing{"client prepares", 4.0, from};
    Row life{"a frame: head sample to its first photon", 5.0, from};
    TimePoint free = from;
    std::uint64_t newest_frame = 0;
    for (const DisplayRecord& part : result.parts) {
        const bool inside = part.scanout_begin > from && part.scanout_begin < to;
        if (inside) scanout.tick(part.scanout_begin, 0.5);
        if (!part.presented) continue;
        if (inside) {
            if (part.latched > free) waiting.bar(free, part.latched);
            warping.bar(part.warp_begin, part.warp_end);
            presenting.bar(part.warp_end, *part.presented);
            if (part.frame_index != newest_frame) life.bar(std::max(from, part.frame_pose_sampled), part.photon);
        }
        newest_frame = part.frame_index;
        free = std::max(from, *part.presented);
    }
    for (const ClientFrameRecord& frame : result.app_frames) {
        if (frame.times.published < from || frame.times.render_begin > to) continue;
        drawing.bar(std::max(from, frame.times.render_begin), std::min(to, frame.times.render_end));
        if (frame.times.render_end < to) preparing.bar(frame.times.render_end, std::min(to, frame.times.published));
    }
    for (const Row* row : {&scanout, &waiting, &warping, &presenting, &drawing, &preparing, &life}) {
        plot.series.push_back(row->series());
    }
    return plot;
}

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
    page.add_plot(timeline_of(result, from_ms(250.0)));
    page.add_plot(latencies_over_time(harness));
    page.add_plot(histogram_of("Motion to photon", "ms", over(harness.refreshes, &SeenRefresh::motion_to_photon)));
    page.add_plot(histogram_of("Frame age", "ms", over(harness.refreshes, &SeenRefresh::frame_age)));
    std::vector<double> warp_ms;
    std::vector<double> late_ms;
    for (const DisplayRecord& part : result.parts) {
        if (!part.presented) continue;
        warp_ms.push_back(to_ms(part.warp_time()));
        late_ms.push_back(to_ms(part.latched - part.planned_wake));
    }
    page.add_plot(histogram_of("Warp", "ms", warp_ms));
    page.add_plot(histogram_of("Lateness of the wake-up", "ms", late_ms));
    return page.text();
}

}  // namespace lw
