#include "apps/billboard_bench_plots.h"

#include <span>

#include "apps/billboard_bench_figures.h"
#include "apps/html_report.h"

namespace lw {
namespace {

template <class Value>
std::vector<double> column(const std::vector<TrialFrame>& frames, Value value) {
    std::vector<double> values;
    values.reserve(frames.size());
    for (const TrialFrame& frame : frames) values.push_back(static_cast<double>(value(frame)));
    return values;
}

std::vector<double> times(const std::vector<TrialFrame>& frames) {
    return column(frames, [](const TrialFrame& frame) { return frame.time_s; });
}

SvgSeries line(std::string label, std::vector<double> x, std::vector<double> y) {
    SvgSeries series;
    series.label = std::move(label);
    series.x = std::move(x);
    series.y = std::move(y);
    series.marks = SvgMarks::line;
    return series;
}

SvgPlot plot(std::string title, std::string x_label, std::string y_label) {
    SvgPlot made{std::move(title), std::move(x_label), std::move(y_label)};
    made.y_from_zero = true;
    return made;
}

SvgPlot time_plot(const std::string& label, const std::vector<TrialFrame>& frames) {
    SvgPlot made = plot(fmt::format("Frame time: {}", label), "path, s", "ms");
    const std::vector<double> x = times(frames);
    made.series = {line("frame", x, column(frames, [](const TrialFrame& f) { return f.frame_ms; })),
                   line("meshes", x, column(frames, [](const TrialFrame& f) { return f.meshes_ms; })),
                   line("creating", x, column(frames, [](const TrialFrame& f) { return f.create_ms; })),
                   line("updating", x, column(frames, [](const TrialFrame& f) { return f.update_ms; })),
                   line("drawing", x, column(frames, [](const TrialFrame& f) { return f.draw_ms; })),
                   line("light", x, column(frames, [](const TrialFrame& f) { return f.light_ms; }))};
    return made;
}

SvgPlot count_plot(const std::string& label, const std::vector<TrialFrame>& frames) {
    SvgPlot made = plot(fmt::format("Billboards per frame: {}", label), "path, s", "billboards");
    const std::vector<double> x = times(frames);
    made.series = {line("active", x, column(frames, [](const TrialFrame& f) { return f.counters.active; })),
                   line("created", x, column(frames, [](const TrialFrame& f) { return f.counters.created; })),
                   line("updated", x, column(frames, [](const TrialFrame& f) { return f.counters.updated; }))};
    return made;
}

SvgPlot dimension_plot(const std::vector<TrialFrame>& frames) {
    SvgPlot made = plot("Active billboards by dimension", "path, s", "billboards");
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        made.series.push_back(
            line(fmt::format("{0} x {0}", kBillboardDimensions[level]), times(frames),
                 column(frames, [level](const TrialFrame& f) { return f.counters.active_by_dimension[level]; })));
    }
    return made;
}

SvgPlot overview_plot(const PairRun& overview) {
    SvgPlot made = plot("Times as fast as the meshes, over the overview at 10 Hz", "path, s", "times");
    std::vector<double> speedups;
    std::vector<double> by_wall;
    for (const FramePair& pair : pairs_of(overview.meshes, overview.ours)) {
        speedups.push_back(pair.speedup(&TrialFrame::frame_ms));
        by_wall.push_back(pair.speedup(&TrialFrame::wall_ms));
    }
    made.series = {line("processor time", times(overview.ours), speedups),
                   line("wall time", times(overview.ours), by_wall)};
    return made;
}

SvgPlot quality_plot(const PathRun& path) {
    SvgPlot made{"Likeness to the meshes along the path", "path, s", "SSIM"};
    std::vector<double> x;
    std::vector<double> flat;
    std::vector<double> warped;
    std::vector<double> ours;
    for (const PathQuality& quality : path.quality) {
        x.push_back(quality.time_s);
        flat.push_back(quality.ssim_flat);
        warped.push_back(quality.ssim_warped);
        ours.push_back(quality.ssim_ours);
    }
    made.series = {line("flat, by angles", x, flat), line("warped, by angles", x, warped),
                   line("warped, by error", x, ours)};
    return made;
}

/// `flip_of`: of a point.
SvgPlot redraw_plot(std::span<const SweepPoint> points, std::string title, double SweepPoint::*flip_of) {
    SvgPlot made = plot(std::move(title), "redraws per frame", "FLIP");
    made.y_from_zero = false;
    for (const char* mode : {"flat", "warped"}) {
        for (const char* criterion : {"error", "angles"}) {
            SvgSeries series;
            series.label = fmt::format("{}, by {}", mode, criterion);
            for (const SweepPoint& point : curve_of(points, mode, criterion)) {
                series.x.push_back(point.redraws_per_frame);
                series.y.push_back(point.*flip_of);
                series.notes.push_back(short_number(point.value));
            }
            if (!series.x.empty()) made.series.push_back(std::move(series));
        }
    }
    return made;
}

}  // namespace

std::vector<std::pair<std::string, SvgPlot>> plots_of(const BillboardBench& bench) {
    std::vector<std::pair<std::string, SvgPlot>> plots;
    plots.emplace_back("frame_time_meshes", time_plot("meshes only", bench.path.meshes));
    std::size_t number = 0;
    for (const auto& [label, frames] : bench.path.trials) {
        plots.emplace_back(fmt::format("frame_time_{}", ++number), time_plot(label, frames));
        plots.emplace_back(fmt::format("billboards_{}", number), count_plot(label, frames));
    }
    plots.emplace_back("dimensions", dimension_plot(bench.path.ours()));
    plots.emplace_back("likeness", quality_plot(bench.path));
    plots.emplace_back("overview", overview_plot(bench.overview));
    plots.emplace_back("redraws",
                       redraw_plot(bench.caps, "Error against redraws, on the dive", &SweepPoint::flip_truth));
    plots.emplace_back(
        "redraws_meshes",
        redraw_plot(bench.caps, "Difference from the meshes against redraws, on the dive", &SweepPoint::flip));
    plots.emplace_back("redraws_beside", redraw_plot(bench.beside, "Error against redraws, on a walk to the side",
                                                     &SweepPoint::flip_truth));
    return plots;
}

}  // namespace lw
