#include "apps/billboard_bench_report.h"

#include <span>

#include "apps/billboard_bench_figures.h"
#include "apps/billboard_bench_plots.h"
#include "apps/billboard_bench_tables.h"

namespace lw {
namespace {

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
        entry.set("eligible", is_eligible(f));
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

/// Into the page and the summary.
void add_table(const BenchTable& table, BenchOutput& output) {
    output.page.add_heading(table.heading);
    output.page.add_table(table.rows);
    output.summary += fmt::format("\n{}\n", table.heading);
    for (const std::vector<std::string>& row : table.rows) {
        for (const std::string& cell : row) output.summary += fmt::format("{:>18} ", cell);
        output.summary += "\n";
    }
}

void add_figures(Report& report, const BillboardFigures& figures) {
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
}

}  // namespace

BenchOutput output_of(const BillboardBench& bench, const scene::Scene& scene) {
    const BillboardFigures figures = figures_of(bench);
    BenchOutput output;
    Report& report = output.report;
    const Machine machine = this_machine();
    describe_machine(report, machine);
    describe_scene(report, scene);
    report.set("size_px", bench.path.size_px);
    add_figures(report, figures);
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
    for (const std::vector<std::string>& row : figure_rows(figures)) {
        output.summary += fmt::format("{:<42} {:>10}\n", row[0], row[1]);
    }
    for (const BenchTable& table : tables_of(bench)) add_table(table, output);
    return output;
}

}  // namespace lw
