/// The suite `warp`: run time of every method against its error.

#include <algorithm>

#include "apps/autotune.h"
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

struct Measured {
    std::vector<BenchPoint> points;
    std::vector<FreshErrors> fresh;
    std::optional<double> busy;
};

/// What an earlier run of the same plan found out, for the part that this one leaves out.
Status merge(const std::filesystem::path& path, const std::string& part, const Machine& machine, Measured& measured) {
    const Result<BenchData> data = load_bench_data(path);
    if (!data) return data.error();
    const bool timed = std::any_of(data->points.begin(), data->points.end(),
                                   [](const BenchPoint& point) { return point.warp_ms.has_value(); });
    if (timed && !is_same_machine(data->machine, machine)) {
        return Error{fmt::format("times of another machine ({})", text_of(data->machine)), path.string(),
                     "take them here, with --part times"};
    }
    for (BenchPoint& point : measured.points) {
        const auto other = std::find_if(data->points.begin(), data->points.end(),
                                        [&](const BenchPoint& earlier) { return is_same_setting(earlier, point); });
        if (other == data->points.end()) {
            return Error{"a report of another plan", path.string(), "merge runs with equal --quick and --data"};
        }
        if (part == "times") point.pairs = other->pairs;
        copy_times(*other, point);
    }
    if (part == "times") measured.fresh = data->fresh;
    measured.busy = data->processor_per_wall;
    return Done{};
}

/// Times first: whether the machine is quiet shows before the long part.
Result<Measured> measure(const Options& options, const SweepPlan& plan, const Machine& machine) {
    const SweepSettings settings{options.threads, options.quiet, options.bench_most_s};
    Measured measured{points_of(plan), {}, {}};
    if (!options.bench_merge.empty()) {
        const Status merged = merge(options.bench_merge, options.bench_part, machine, measured);
        if (!merged) return merged.error();
    }
    if (options.bench_part != "errors") {
        const Result<std::optional<double>> busy = measure_times(plan, settings, kRepeats, measured.points);
        if (!busy) return busy.error();
        // Of several pieces the worst one speaks.
        if (*busy) measured.busy = std::min(**busy, measured.busy.value_or(1.0));
    }
    if (options.bench_part != "times") {
        Result<std::vector<FreshErrors>> fresh = measure_errors(plan, settings, measured.points);
        if (!fresh) return fresh.error();
        measured.fresh = *std::move(fresh);
    }
    mark_pareto_fronts(measured.points);
    return measured;
}

void describe_quiet(Report& report, const std::optional<double>& busy) {
    report.set("processor_per_wall", busy);
    if (!busy || *busy >= kQuiet) return;
    report.set("suspect",
               fmt::format("others were running: a single thread had {:.0f} % of a processor", *busy * 100.0));
}

}  // namespace

Result<BenchOutput> bench_warp(const Options& options) {
    const SweepPlan plan = warp_sweep_plan(options.quick, options.data);
    print_warnings(plan.warnings, options.quiet);
    const Machine machine = this_machine();
    const Result<Measured> measured = measure(options, plan, machine);
    if (!measured) return measured.error();
    const std::vector<BenchPoint>& points = measured->points;

    BenchOutput output;
    describe_machine(output.report, machine);
    describe_plan(output.report, plan);
    output.report.set("settings/part", options.bench_part);
    describe_quiet(output.report, measured->busy);
    add_points(output.report, points);
    add_fresh(output.report, measured->fresh);
    output.plots = warp_sweep_plots(plan, points, measured->fresh);
    output.csv = warp_sweep_csv(points);
    output.page = warp_sweep_page(plan, points, output.plots, text_of(machine));
    output.summary = summary_of(points);
    if (std::any_of(points.begin(), points.end(), [](const BenchPoint& point) { return point.on_front.has_value(); })) {
        output.kept_at = measured_data_path();
    }
    return output;
}

}  // namespace lw
