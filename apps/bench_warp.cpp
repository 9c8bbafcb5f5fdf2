/// The suite `warp`: run time of every method against its error.

#include "apps/bench_point.h"
#include "apps/bench_suites.h"
#include "apps/scene_stage.h"
#include "apps/warp_sweep_plan.h"
#include "apps/warp_sweep_report.h"
#include "apps/warp_sweep_run.h"

namespace lw {

namespace {

constexpr int kRepeats = 33;
/// Less processor time than this per wall time of a single thread: others were running.
constexpr double kQuiet = 0.9;

std::string summary_of(const std::vector<BenchPoint>& points) {
    std::string text = fmt::format("{:<22} {:>28} {:>9} {:>8} {:>8} {:>8}\n", "on the front", "fill", "warp ms",
                                   "/memcpy", "FLIP", "SSIM");
    for (const BenchPoint& point : points) {
        if (!point.on_front.value_or(false) || point.conditions.frame_age_ms != 100.0) continue;
        const ImageErrors errors = *point.errors();
        text += fmt::format("{:<22} {:>28} {:>9.2f} {:>8.1f} {:>8.4f} {:>8.4f}  {}\n", point.method, point.fill,
                            point.warp_ms->p50, point.memcpy_ratio.value_or(0.0), errors.flip, errors.ssim,
                            text_of(point.conditions));
    }
    return text;
}

void describe_plan(Report& report, const SweepPlan& plan) {
    report.set("settings/truth_samples", plan.truth_samples);
    report.set("settings/repeats", kRepeats);
    for (const SweepPair& pair : plan.pairs) {
        Report entry;
        entry.set("scene", pair.scene_label);
        entry.set("trace", pair.trace_label);
        entry.set("trace_start_s", pair.trace_start_s);
        report.append("settings/pairs", entry);
    }
}

void add_fresh(Report& report, const std::vector<FreshErrors>& fresh) {
    for (const FreshErrors& errors : fresh) {
        BenchPoint mean;
        mean.pairs = errors.pairs;
        const std::optional<ImageErrors> all = mean.errors();
        Report entry;
        entry.set("size_px", errors.size_px);
        entry.set("samples", errors.samples);
        entry.set("flip", all->flip);
        entry.set("ssim", all->ssim);
        entry.set("psnr_db", all->psnr_db);
        report.append("fresh", entry);
    }
}

}  // namespace

Result<BenchOutput> bench_warp(const Options& options) {
    const SweepPlan plan = warp_sweep_plan(options.quick, options.data);
    print_warnings(plan.warnings, options.quiet);
    const SweepSettings settings{options.threads, options.quiet};
    std::vector<BenchPoint> points = points_of(plan);
    // Times first: the machine is cooler, and what else it does shows before the long part.
    const Result<double> busy = measure_times(plan, settings, kRepeats, points);
    if (!busy) return busy.error();
    const Result<std::vector<FreshErrors>> fresh = measure_errors(plan, settings, points);
    if (!fresh) return fresh.error();
    mark_pareto_fronts(points);

    BenchOutput output;
    const Machine machine = this_machine();
    describe_machine(output.report, machine);
    describe_plan(output.report, plan);
    output.report.set("busy", *busy);
    if (*busy < kQuiet) {
        output.report.set("suspect", fmt::format("the machine was busy: {:.0f} % of the wall time", *busy * 100.0));
    }
    add_points(output.report, points);
    add_fresh(output.report, *fresh);
    output.plots = warp_sweep_plots(plan, points, *fresh);
    output.csv = warp_sweep_csv(points);
    output.page = warp_sweep_page(plan, points, output.plots, text_of(machine));
    output.summary = summary_of(points);
    return output;
}

}  // namespace lw
