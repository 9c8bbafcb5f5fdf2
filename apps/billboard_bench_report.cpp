#include "apps/billboard_bench_report.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace lw {

namespace {

constexpr double kEligibleShare = 0.8;
constexpr std::uint64_t kEligibleRedraws = 64;
const double kDefaultCap_px = BillboardSettings{}.error_cap_px;

std::uint64_t redraws(const TrialFrame& frame) { return frame.counters.created + frame.counters.updated; }

bool eligible(const TrialFrame& frame) {
    const auto in_view = static_cast<double>(frame.counters.triangles_in_view);
    const auto replaceable = static_cast<double>(frame.counters.triangles_replaceable);
    return in_view > 0.0 && replaceable >= kEligibleShare * in_view && redraws(frame) <= kEligibleRedraws;
}

std::vector<SweepPoint> curve_of(std::span<const SweepPoint> points, const char* mode, const char* criterion) {
    std::vector<SweepPoint> curve;
    for (const SweepPoint& point : points) {
        if (point.mode == mode && point.criterion == criterion) curve.push_back(point);
    }
    return curve;
}

double flicker_of(std::span<const FlickerPoint> points, bool fades, double FlickerPoint::*value) {
    for (const FlickerPoint& point : points) {
        if (point.mode == "warped" && (point.fade_frames > 0) == fades) return point.*value;
    }
    return 0.0;
}

/// With fades to without, of warped billboards.
double flicker_ratio(std::span<const FlickerPoint> points, double FlickerPoint::*value) {
    const double without = flicker_of(points, false, value);
    return without > 0.0 ? flicker_of(points, true, value) / without : 0.0;
}

/// Frames of ours that were drawn right after the same frame of meshes.
struct FramePair {
    const TrialFrame* meshes;
    const TrialFrame* ours;

    [[nodiscard]] double speedup(double TrialFrame::*ms) const { return meshes->*ms / ours->*ms; }
};

std::vector<FramePair> pairs_of(const std::vector<TrialFrame>& meshes, const std::vector<TrialFrame>& ours) {
    std::vector<FramePair> pairs;
    for (std::size_t k = 0; k < std::min(meshes.size(), ours.size()); ++k) pairs.push_back({&meshes[k], &ours[k]});
    return pairs;
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

using Rows = std::vector<std::vector<std::string>>;

Rows sweep_rows(std::span<const SweepPoint> points, const char* value_name) {
    Rows rows{{"billboards", "criterion", value_name, "redraws per frame", "FLIP to truth", "FLIP to meshes",
               "SSIM to meshes", "worst SSIM", "active", "frame ms", "worst update to median"}};
    for (const SweepPoint& p : points) {
        rows.push_back({p.mode, p.criterion, short_number(p.value), short_number(p.redraws_per_frame),
                        fmt::format("{:.5f}", p.flip_truth), fmt::format("{:.5f}", p.flip),
                        fmt::format("{:.4f}", p.ssim), fmt::format("{:.4f}", p.worst_ssim), short_number(p.active),
                        short_number(p.frame_ms), short_number(p.worst_to_median)});
    }
    return rows;
}

Rows criteria_rows(const SweepPoint& meshes, std::span<const SweepPoint> settings) {
    std::vector<SweepPoint> points{meshes};
    points.insert(points.end(), settings.begin(), settings.end());
    return sweep_rows(points, "cap, px, or times the angles");
}

Rows redraw_rows(std::span<const SweepPoint> points) {
    Rows rows{{"flat, by", "value", "FLIP to truth", "redraws per frame", "warped, as good with", "share"}};
    for (const RedrawShare& share : redraw_shares(points)) {
        rows.push_back({share.flat.criterion, short_number(share.flat.value),
                        fmt::format("{:.5f}", share.flat.flip_truth), short_number(share.flat.redraws_per_frame),
                        share.warped_redraws ? short_number(*share.warped_redraws) : "not reached",
                        short_number(share.share())});
    }
    return rows;
}

const char* name_of(PairSchedule schedule) { return schedule == PairSchedule::angles ? "angles" : "error of warped"; }

Rows likeness_rows(std::span<const LikenessPoint> points) {
    Rows rows{{"drawn anew by", "flat", "client, Hz", "frames", "all fresh", "equal", "warped nearer", "fresh quads",
               "SSIM, flat", "SSIM, warped", "lost at most"}};
    for (const LikenessPoint& p : points) {
        rows.push_back({name_of(p.schedule), p.flat_blended ? "blended" : "nearest", short_number(p.client_hz),
                        fmt::format("{}", p.frames()), fmt::format("{}", p.fresh), fmt::format("{}", p.equal),
                        fmt::format("{}", p.better), fmt::format("{:.0f} %", 100.0 * p.fresh_share),
                        fmt::format("{:.5f}", p.ssim_flat), fmt::format("{:.5f}", p.ssim_warped),
                        fmt::format("{:.6f}", p.worst_loss)});
    }
    return rows;
}

Rows still_rows(std::span<const StillPoint> points) {
    Rows rows{{"", "SSIM", "FLIP", "updates", "choosing ms", "drawing ms", "bytes per texel"}};
    for (const StillPoint& p : points) {
        rows.push_back({p.label, fmt::format("{:.5f}", p.ssim), fmt::format("{:.5f}", p.flip),
                        fmt::format("{}", p.updates), short_number(p.choose_ms), short_number(p.draw_ms),
                        fmt::format("{}", p.bytes_per_texel)});
    }
    return rows;
}

Rows flicker_rows(std::span<const FlickerPoint> points) {
    Rows rows{
        {"billboards", "fade, frames", "updates", "updates alone", "per update", "by pixel", "flicker", "worst frame"}};
    for (const FlickerPoint& p : points) {
        rows.push_back({p.mode, fmt::format("{}", p.fade_frames), fmt::format("{}", p.updates), short_number(p.pop),
                        short_number(p.pop_per_update), short_number(p.pop_by_pixel), short_number(p.flicker),
                        short_number(p.worst_flicker)});
    }
    return rows;
}

Rows memory_rows(const PathRun& path) {
    Rows rows{{"slot", "MB, 10 bytes per texel", "MB, 13 bytes", "MB, 16 bytes"}};
    std::size_t sum = 0;
    const auto row = [&rows](std::string label, std::size_t bytes) {
        const double megabytes = static_cast<double>(bytes) * 1e-6;
        rows.push_back(
            {std::move(label), short_number(megabytes), short_number(1.3 * megabytes), short_number(1.6 * megabytes)});
    };
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        row(fmt::format("{0} x {0}", kBillboardDimensions[level]), path.bytes[level]);
        sum += path.bytes[level];
    }
    row("in all", sum);
    return rows;
}

Rows figure_rows(const BillboardFigures& f) {
    return {{"figure", "value"},
            {"speed-up, best 100 frames at least", short_number(f.speedup_best_100)},
            {"the same by processor time", short_number(f.speedup_best_100_processor)},
            {fmt::format("speed-up, {} eligible frames at least", f.eligible), short_number(f.speedup_min_eligible)},
            {"the same by processor time", short_number(f.speedup_min_eligible_processor)},
            {"SSIM, mean", fmt::format("{:.4f}", f.ssim_mean)},
            {"SSIM, worst", fmt::format("{:.4f}", f.ssim_min)},
            {"frames with warped nearer than flat, by angles", fmt::format("{:.1f} %", 100.0 * f.warped_better)},
            {"the same by the error of warped ones", fmt::format("{:.1f} %", 100.0 * f.warped_better_by_error)},
            {"SSIM lost in the others, at most", fmt::format("{:.6f}", f.warped_loss)},
            {"redraws, warped to flat at equal FLIP", short_number(f.redraw_ratio)},
            {"the same on a walk to the side", short_number(f.redraw_ratio_beside)},
            {"flicker of updates, with fade to without", short_number(f.flicker_ratio)},
            {"the same per update", short_number(f.flicker_ratio_per_update)},
            {"worst update to median, with a budget", short_number(f.worst_to_median)}};
}

std::string csv_of(const PathRun& path) {
    std::string csv =
        "trial,time_s,mesh_frame_ms,wall_ms,frame_ms,meshes_ms,choose_ms,create_ms,update_ms,draw_ms,light_ms,active,"
        "created,"
        "updated,near,queue,atlas,triangles_in_view,triangles_replaceable\n";
    for (const auto& [label, frames] : path.trials) {
        for (std::size_t k = 0; k < frames.size(); ++k) {
            const TrialFrame& f = frames[k];
            csv += fmt::format(
                "\"{}\",{:.2f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{},{},{},{},{},{},{},{}"
                "\n",
                label, f.time_s, path.meshes[k].frame_ms, f.wall_ms, f.frame_ms, f.meshes_ms, f.choose_ms, f.create_ms,
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
        entry.set("mesh_wall_ms", path.meshes[k].wall_ms);
        entry.set("wall_ms", f.wall_ms);
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
            entry.set("flip_truth", p.flip_truth);
            entry.set("flip", p.flip);
            entry.set("ssim", p.ssim);
            entry.set("worst_ssim", p.worst_ssim);
            entry.set("frame_ms", p.frame_ms);
            entry.set("worst_to_median", p.worst_to_median);
            report.append(path, entry);
        }
    };
    add("billboards/meshes", std::span{&bench.meshes, 1});
    add("billboards/caps", bench.caps);
    add("billboards/meshes_beside", std::span{&bench.meshes_beside, 1});
    add("billboards/beside", bench.beside);
    add("billboards/budgets", bench.budgets);
    add("billboards/thresholds", bench.thresholds);
}

void add_likeness(Report& report, std::span<const LikenessPoint> points) {
    for (const LikenessPoint& p : points) {
        Report entry;
        entry.set("schedule", name_of(p.schedule));
        entry.set("flat_blended", p.flat_blended);
        entry.set("client_hz", p.client_hz);
        entry.set("frames", static_cast<std::int64_t>(p.frames()));
        entry.set("fresh", static_cast<std::int64_t>(p.fresh));
        entry.set("equal", static_cast<std::int64_t>(p.equal));
        entry.set("better", static_cast<std::int64_t>(p.better));
        entry.set("fresh_share", p.fresh_share);
        entry.set("ssim_flat", p.ssim_flat);
        entry.set("ssim_warped", p.ssim_warped);
        entry.set("worst_loss", p.worst_loss);
        report.append("billboards/likeness", entry);
    }
}

void add_still(Report& report, const char* path, std::span<const StillPoint> points) {
    for (const StillPoint& p : points) {
        Report entry;
        entry.set("label", p.label);
        entry.set("ssim", p.ssim);
        entry.set("flip", p.flip);
        entry.set("updates", p.updates);
        entry.set("choose_ms", p.choose_ms);
        entry.set("draw_ms", p.draw_ms);
        report.append(path, entry);
    }
}

/// All tables, into the page and the summary.
void add_tables(const BillboardBench& bench, const BillboardFigures& figures, BenchOutput& output) {
    for (const std::vector<std::string>& row : figure_rows(figures)) {
        output.summary += fmt::format("{:<42} {:>10}\n", row[0], row[1]);
    }
    const std::pair<const char*, Rows> tables[] = {
        {"Flat against warped with the same redraws", likeness_rows(bench.likeness)},
        {"Error and redraws by criterion, on the dive", criteria_rows(bench.meshes, bench.caps)},
        {"Redraws for the same error, on the dive", redraw_rows(bench.caps)},
        {"Error and redraws by criterion, on a walk to the side", criteria_rows(bench.meshes_beside, bench.beside)},
        {"Redraws for the same error, on a walk to the side", redraw_rows(bench.beside)},
        {"Share of the scene within which objects stay meshes", sweep_rows(bench.thresholds, "share")},
        {"Time for updates", sweep_rows(bench.budgets, "budget, ms")},
        {"Flicker while the eye moves", flicker_rows(bench.flicker)},
        {"A still camera: layouts", still_rows(bench.still)},
        {"Layouts, 3 m beside where the billboards were drawn", still_rows(bench.layouts)},
        {"Ways to make quads", still_rows(bench.expansions)},
        {"Touching objects, 3 m beside where the billboards were drawn", still_rows(bench.groups)},
        {"Flat billboards without depth, 3 m beside where they were drawn", still_rows(bench.depthless)},
        {"Flat and warped, after motion without updates", still_rows(bench.motions)},
        {"Memory", memory_rows(bench.path)}};
    for (const auto& [heading, rows] : tables) {
        output.page.add_heading(heading);
        output.page.add_table(rows);
        output.summary += fmt::format("\n{}\n", heading);
        for (const std::vector<std::string>& row : rows) {
            for (const std::string& cell : row) output.summary += fmt::format("{:>18} ", cell);
            output.summary += "\n";
        }
    }
}

}  // namespace

std::optional<double> redraws_for_flip(std::span<const SweepPoint> curve, double flip) {
    std::vector<SweepPoint> sorted{curve.begin(), curve.end()};
    std::ranges::stable_sort(sorted, {}, &SweepPoint::redraws_per_frame);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
        const SweepPoint& b = sorted[i];
        if (b.flip_truth > flip) continue;
        if (i == 0) return b.redraws_per_frame;
        const SweepPoint& a = sorted[i - 1];
        return std::lerp(a.redraws_per_frame, b.redraws_per_frame,
                         (flip - a.flip_truth) / (b.flip_truth - a.flip_truth));
    }
    return std::nullopt;
}

double share_better(std::span<const LikenessPoint> points) {
    int better = 0;
    int judged = 0;
    for (const LikenessPoint& point : points) {
        better += point.better;
        judged += point.frames() - point.fresh;
    }
    return judged == 0 ? 0.0 : static_cast<double>(better) / judged;
}

std::vector<RedrawShare> redraw_shares(std::span<const SweepPoint> points) {
    const std::vector<SweepPoint> warped = curve_of(points, "warped", "error");
    std::vector<RedrawShare> shares;
    for (const SweepPoint& flat : points) {
        if (flat.mode != "flat") continue;
        shares.push_back({flat, redraws_for_flip(warped, flat.flip_truth)});
    }
    return shares;
}

namespace {

double share_at_default_cap(std::span<const SweepPoint> points) {
    for (const RedrawShare& share : redraw_shares(points)) {
        if (share.flat.criterion == "error" && share.flat.value == kDefaultCap_px) return share.share();
    }
    return 0.0;
}

std::vector<LikenessPoint> likeness_of(std::span<const LikenessPoint> points, PairSchedule schedule,
                                       bool flat_blended) {
    std::vector<LikenessPoint> some;
    for (const LikenessPoint& point : points) {
        if (point.schedule == schedule && point.flat_blended == flat_blended) some.push_back(point);
    }
    return some;
}

/// Against flat ones as they are.
void set_likeness(std::span<const LikenessPoint> points, BillboardFigures& figures) {
    figures.warped_better = share_better(likeness_of(points, PairSchedule::angles, false));
    figures.warped_better_by_error = share_better(likeness_of(points, PairSchedule::warped_error, false));
    for (const LikenessPoint& point : points) {
        if (!point.flat_blended) figures.warped_loss = std::max(figures.warped_loss, point.worst_loss);
    }
}

double least_of_best_100(const PairRun& overview, double TrialFrame::*ms) {
    std::vector<double> speedups;
    for (const FramePair& pair : pairs_of(overview.meshes, overview.ours)) speedups.push_back(pair.speedup(ms));
    std::ranges::sort(speedups, std::greater{});
    return speedups.empty() ? 0.0 : speedups[std::min<std::size_t>(speedups.size(), 100) - 1];
}

double least_of(std::span<const FramePair> pairs, double TrialFrame::*ms) {
    double least = std::numeric_limits<double>::infinity();
    for (const FramePair& pair : pairs) least = std::min(least, pair.speedup(ms));
    return least;
}

void set_speedups(const BillboardBench& bench, BillboardFigures& figures) {
    figures.speedup_best_100 = least_of_best_100(bench.overview, &TrialFrame::wall_ms);
    figures.speedup_best_100_processor = least_of_best_100(bench.overview, &TrialFrame::frame_ms);
    std::vector<FramePair> pairs = pairs_of(bench.path.meshes, bench.path.ours());
    std::ranges::copy(pairs_of(bench.overview.meshes, bench.overview.ours), std::back_inserter(pairs));
    std::erase_if(pairs, [](const FramePair& pair) { return !eligible(*pair.ours); });
    figures.eligible = pairs.size();
    figures.speedup_min_eligible = least_of(pairs, &TrialFrame::wall_ms);
    figures.speedup_min_eligible_processor = least_of(pairs, &TrialFrame::frame_ms);
}

}  // namespace

BillboardFigures figures_of(const BillboardBench& bench) {
    BillboardFigures figures;
    set_speedups(bench, figures);
    figures.ssim_mean = 0.0;
    for (const PathQuality& quality : bench.path.quality) {
        const auto count = static_cast<double>(bench.path.quality.size());
        figures.ssim_mean += quality.ssim_ours / count;
        figures.ssim_min = std::min(figures.ssim_min, quality.ssim_ours);
    }
    set_likeness(bench.likeness, figures);
    figures.redraw_ratio = share_at_default_cap(bench.caps);
    figures.redraw_ratio_beside = share_at_default_cap(bench.beside);
    figures.flicker_ratio = flicker_ratio(bench.flicker, &FlickerPoint::pop);
    figures.flicker_ratio_per_update = flicker_ratio(bench.flicker, &FlickerPoint::pop_per_update);
    if (!bench.budgets.empty()) figures.worst_to_median = bench.budgets.back().worst_to_median;
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
    report.set("billboards/speedup_best_100_processor", figures.speedup_best_100_processor);
    report.set("billboards/speedup_min_eligible", figures.speedup_min_eligible);
    report.set("billboards/speedup_min_eligible_processor", figures.speedup_min_eligible_processor);
    report.set("billboards/eligible_frames", static_cast<std::int64_t>(figures.eligible));
    report.set("billboards/ssim_mean", figures.ssim_mean);
    report.set("billboards/ssim_min", figures.ssim_min);
    report.set("billboards/warped_better", figures.warped_better);
    report.set("billboards/warped_better_by_error", figures.warped_better_by_error);
    report.set("billboards/warped_loss", figures.warped_loss);
    report.set("billboards/redraw_ratio", figures.redraw_ratio);
    report.set("billboards/redraw_ratio_beside", figures.redraw_ratio_beside);
    report.set("billboards/flicker_ratio", figures.flicker_ratio);
    report.set("billboards/flicker_ratio_per_update", figures.flicker_ratio_per_update);
    report.set("billboards/worst_to_median", figures.worst_to_median);
    report.set("billboards/bytes_per_pixel", bytes_per_texel(AtlasFormat::packed));
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) {
        report.set(fmt::format("billboards/bytes/{}", kBillboardDimensions[level]),
                   static_cast<std::int64_t>(bench.path.bytes[level]));
    }
    add_points(report, bench);
    add_likeness(report, bench.likeness);
    add_frames(report, bench.path);
    add_still(report, "billboards/still", bench.still);
    add_still(report, "billboards/layouts", bench.layouts);
    add_still(report, "billboards/expansions", bench.expansions);
    add_still(report, "billboards/groups", bench.groups);
    add_still(report, "billboards/depthless", bench.depthless);
    add_still(report, "billboards/motions", bench.motions);

    output.plots = plots_of(bench);
    output.csv = csv_of(bench.path);
    output.page = HtmlReport{"Billboards"};
    output.page.add_paragraph(text_of(machine));
    output.page.add_table(figure_rows(figures));
    for (const auto& entry : output.plots) output.page.add_plot(entry.second);
    add_tables(bench, figures, output);
    return output;
}

}  // namespace lw
