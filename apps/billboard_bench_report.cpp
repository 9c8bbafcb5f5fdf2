#include "apps/billboard_bench_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/statistics.h"

namespace lw {

namespace {

constexpr double kEligibleShare = 0.8;
constexpr std::uint64_t kEligibleRedraws = 64;

std::uint64_t redraws(const TrialFrame& frame) { return frame.counters.created + frame.counters.updated; }

bool eligible(const TrialFrame& frame) {
    const auto in_view = static_cast<double>(frame.counters.triangles_in_view);
    const auto replaceable = static_cast<double>(frame.counters.triangles_replaceable);
    return in_view > 0.0 && replaceable >= kEligibleShare * in_view && redraws(frame) <= kEligibleRedraws;
}

std::vector<SweepPoint> curve_of(const BillboardBench& bench, const char* mode, const char* criterion) {
    std::vector<SweepPoint> curve;
    for (const SweepPoint& point : bench.caps) {
        if (point.mode == mode && point.criterion == criterion) curve.push_back(point);
    }
    return curve;
}

/// Redraws of warped billboards over those of flat ones, at the FLIPs of the warped curve that the flat one reaches:
/// the largest of these ratios.
double redraw_ratio(const BillboardBench& bench) {
    const std::vector<SweepPoint> flat = curve_of(bench, "flat", "error");
    double worst = 0.0;
    for (const SweepPoint& point : curve_of(bench, "warped", "error")) {
        const std::optional<double> needed = redraws_for_flip(flat, point.flip);
        if (needed && *needed > 0.0) worst = std::max(worst, point.redraws_per_frame / *needed);
    }
    return worst;
}

double flicker_of(const BillboardBench& bench, const char* mode, bool fades) {
    for (const FlickerPoint& point : bench.flicker) {
        if (point.mode == mode && (point.fade_frames > 0) == fades) return point.flicker;
    }
    return 0.0;
}

template <class Value>
std::vector<double> column(const std::vector<TrialFrame>& frames, Value value) {
    std::vector<double> values;
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

SvgPlot redraw_plot(const BillboardBench& bench) {
    SvgPlot made = plot("Error against redraws", "redraws per frame", "FLIP");
    for (const char* mode : {"flat", "warped"}) {
        for (const char* criterion : {"error", "angles"}) {
            SvgSeries series;
            series.label = fmt::format("{}, by {}", mode, criterion);
            for (const SweepPoint& point : curve_of(bench, mode, criterion)) {
                series.x.push_back(point.redraws_per_frame);
                series.y.push_back(point.flip);
                series.notes.push_back(short_number(point.value));
            }
            made.series.push_back(std::move(series));
        }
    }
    return made;
}

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
    plots.emplace_back("redraws", redraw_plot(bench));
    return plots;
}

using Rows = std::vector<std::vector<std::string>>;

Rows sweep_rows(std::span<const SweepPoint> points, const char* value_name) {
    Rows rows{{"billboards", "criterion", value_name, "redraws per frame", "FLIP", "SSIM", "worst SSIM", "active",
               "frame ms"}};
    for (const SweepPoint& p : points) {
        rows.push_back({p.mode, p.criterion, short_number(p.value), short_number(p.redraws_per_frame),
                        fmt::format("{:.4f}", p.flip), fmt::format("{:.4f}", p.ssim),
                        fmt::format("{:.4f}", p.worst_ssim), short_number(p.active), short_number(p.frame_ms)});
    }
    return rows;
}

Rows still_rows(std::span<const StillPoint> points) {
    Rows rows{{"", "SSIM", "FLIP", "updates", "drawing ms", "bytes per texel"}};
    for (const StillPoint& p : points) {
        rows.push_back({p.label, fmt::format("{:.5f}", p.ssim), fmt::format("{:.5f}", p.flip),
                        fmt::format("{}", p.updates), short_number(p.draw_ms), fmt::format("{}", p.bytes_per_texel)});
    }
    return rows;
}

Rows flicker_rows(std::span<const FlickerPoint> points) {
    Rows rows{{"billboards", "fade, frames", "flicker", "worst frame"}};
    for (const FlickerPoint& p : points) {
        rows.push_back(
            {p.mode, fmt::format("{}", p.fade_frames), short_number(p.flicker), short_number(p.worst_flicker)});
    }
    return rows;
}

Rows figure_rows(const BillboardFigures& f) {
    return {{"figure", "value"},
            {"speed-up, best 100 frames at least", short_number(f.speedup_best_100)},
            {fmt::format("speed-up, {} eligible frames at least", f.eligible), short_number(f.speedup_min_eligible)},
            {"SSIM, mean", fmt::format("{:.4f}", f.ssim_mean)},
            {"SSIM, worst", fmt::format("{:.4f}", f.ssim_min)},
            {"frames in which warped beats flat", fmt::format("{:.1f} %", 100.0 * f.warped_better)},
            {"redraws, warped to flat at equal FLIP", short_number(f.redraw_ratio)},
            {"flicker, with fade to without", short_number(f.flicker_ratio)},
            {"worst frame to median, by billboards", short_number(f.worst_to_median)}};
}

std::string csv_of(const PathRun& path) {
    std::string csv =
        "trial,time_s,mesh_frame_ms,frame_ms,meshes_ms,choose_ms,create_ms,update_ms,draw_ms,light_ms,active,created,"
        "updated,near,queue,atlas,triangles_in_view,triangles_replaceable\n";
    for (const auto& [label, frames] : path.trials) {
        for (std::size_t k = 0; k < frames.size(); ++k) {
            const TrialFrame& f = frames[k];
            csv += fmt::format(
                "\"{}\",{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{},{},{}\n",
                label, f.time_s, path.meshes[k].frame_ms, f.frame_ms, f.meshes_ms, f.choose_ms, f.create_ms,
                f.update_ms, f.draw_ms, f.light_ms, f.counters.active, f.counters.created, f.counters.updated,
                f.counters.near_meshes, f.counters.queue_meshes, f.counters.atlas_meshes, f.counters.triangles_in_view,
                f.counters.triangles_replaceable);
        }
    }
    return csv;
}

void add_frames(Report& report, const PathRun& path) {
    for (std::size_t k = 0; k < path.ours().size(); ++k) {
        const TrialFrame& f = path.ours()[k];
        Report entry;
        entry.set("time_s", f.time_s);
        entry.set("mesh_frame_ms", path.meshes[k].frame_ms);
        entry.set("frame_ms", f.frame_ms);
        entry.set("active", f.counters.active);
        entry.set("created", f.counters.created);
        entry.set("updated", f.counters.updated);
        entry.set("eligible", eligible(f));
        report.append("billboards/frames", entry);
    }
}

void add_points(Report& report, const BillboardBench& bench) {
    const auto add = [&report](const char* path, std::span<const SweepPoint> points) {
        for (const SweepPoint& p : points) {
            Report entry;
            entry.set("mode", p.mode);
            entry.set("criterion", p.criterion);
            entry.set("value", p.value);
            entry.set("redraws_per_frame", p.redraws_per_frame);
            entry.set("flip", p.flip);
            entry.set("ssim", p.ssim);
            entry.set("worst_ssim", p.worst_ssim);
            entry.set("frame_ms", p.frame_ms);
            report.append(path, entry);
        }
    };
    add("billboards/caps", bench.caps);
    add("billboards/thresholds", bench.thresholds);
}

}  // namespace

std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip) {
    std::vector<SweepPoint> sorted{curve.begin(), curve.end()};
    std::ranges::stable_sort(sorted, {}, &SweepPoint::redraws_per_frame);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
        const SweepPoint& a = sorted[i - 1];
        const SweepPoint& b = sorted[i];
        if ((a.flip - flip) * (b.flip - flip) > 0.0 || a.flip == b.flip) continue;
        return std::lerp(a.redraws_per_frame, b.redraws_per_frame, (flip - a.flip) / (b.flip - a.flip));
    }
    return std::nullopt;
}

BillboardFigures figures_of(const BillboardBench& bench) {
    BillboardFigures figures;
    std::vector<double> speedups;
    figures.speedup_min_eligible = std::numeric_limits<double>::infinity();
    const std::vector<TrialFrame>& ours = bench.path.ours();
    for (std::size_t k = 0; k < ours.size(); ++k) {
        const double speedup = bench.path.meshes[k].frame_ms / ours[k].frame_ms;
        speedups.push_back(speedup);
        if (!eligible(ours[k])) continue;
        ++figures.eligible;
        figures.speedup_min_eligible = std::min(figures.speedup_min_eligible, speedup);
    }
    std::ranges::sort(speedups, std::greater{});
    if (!speedups.empty()) figures.speedup_best_100 = speedups[std::min<std::size_t>(speedups.size(), 100) - 1];

    figures.ssim_mean = 0.0;
    for (const PathQuality& quality : bench.path.quality) {
        const auto count = static_cast<double>(bench.path.quality.size());
        figures.ssim_mean += quality.ssim_ours / count;
        figures.ssim_min = std::min(figures.ssim_min, quality.ssim_ours);
        if (quality.ssim_warped >= quality.ssim_flat) figures.warped_better += 1.0 / count;
    }
    const double without = flicker_of(bench, "warped", false);
    if (without > 0.0) figures.flicker_ratio = flicker_of(bench, "warped", true) / without;
    figures.redraw_ratio = redraw_ratio(bench);

    std::vector<double> frame_ms = column(ours, [](const TrialFrame& f) { return f.frame_ms; });
    std::ranges::sort(frame_ms);
    if (!frame_ms.empty()) {
        const double median_ms = percentile_of_sorted(frame_ms, 50.0);
        for (const TrialFrame& f : ours) {
            figures.worst_to_median =
                std::max(figures.worst_to_median, (median_ms + f.create_ms + f.update_ms) / median_ms);
        }
    }
    return figures;
}

BenchOutput output_of(const BillboardBench& bench, const scene::Scene& scene) {
    const BillboardFigures figures = figures_of(bench);
    BenchOutput output;
    Report& report = output.report;
    const Machine machine = this_machine();
    describe_machine(report, machine);
    describe_scene(report, scene);
    report.set("size_px", bench.path.size_px);
    report.set("billboards/speedup_best_100", figures.speedup_best_100);
    report.set("billboards/speedup_min_eligible", figures.speedup_min_eligible);
    report.set("billboards/eligible_frames", static_cast<std::int64_t>(figures.eligible));
    report.set("billboards/ssim_mean", figures.ssim_mean);
    report.set("billboards/ssim_min", figures.ssim_min);
    report.set("billboards/warped_better", figures.warped_better);
    report.set("billboards/redraw_ratio", figures.redraw_ratio);
    report.set("billboards/flicker_ratio", figures.flicker_ratio);
    report.set("billboards/bytes_per_pixel", bytes_per_texel(AtlasFormat::packed));
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        report.set(fmt::format("billboards/bytes/{}", kBillboardDimensions[level]),
                   static_cast<std::int64_t>(bench.path.bytes[level]));
    }
    add_points(report, bench);
    add_frames(report, bench.path);

    output.plots = plots_of(bench);
    output.csv = csv_of(bench.path);
    output.page = HtmlReport{"Billboards"};
    output.page.add_paragraph(text_of(machine));
    output.page.add_table(figure_rows(figures));
    for (const auto& entry : output.plots) output.page.add_plot(entry.second);
    output.page.add_heading("Error and redraws by criterion");
    output.page.add_table(sweep_rows(bench.caps, "cap, px, or times the angles"));
    output.page.add_heading("Share of the scene within which objects stay meshes");
    output.page.add_table(sweep_rows(bench.thresholds, "share"));
    output.page.add_heading("Flicker of updates");
    output.page.add_table(flicker_rows(bench.flicker));
    output.page.add_heading("A still camera: layouts");
    output.page.add_table(still_rows(bench.still));
    output.page.add_heading("Ways to make quads");
    output.page.add_table(still_rows(bench.expansions));
    output.page.add_heading("Touching objects, 0.6 m beside where the billboards were drawn");
    output.page.add_table(still_rows(bench.groups));
    for (const std::vector<std::string>& row : figure_rows(figures)) {
        output.summary += fmt::format("{:<42} {:>10}\n", row[0], row[1]);
    }
    for (const Rows& rows :
         {sweep_rows(bench.caps, "value"), sweep_rows(bench.thresholds, "share"), flicker_rows(bench.flicker),
          still_rows(bench.still), still_rows(bench.expansions), still_rows(bench.groups)}) {
        output.summary += "\n";
        for (const std::vector<std::string>& row : rows) {
            for (const std::string& cell : row) output.summary += fmt::format("{:>18} ", cell);
            output.summary += "\n";
        }
    }
    return output;
}

}  // namespace lw
