/// The suite `stability`: how far from its exact place every method puts a sample, and what depth formats and distance
/// from the world's origin cost. Its numbers and plots are those of docs/accuracy.md.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "apps/bench_suites.h"
#include "apps/stability/case_folder.h"
#include "apps/stability/depth_formats.h"
#include "apps/stability/origin_sweep.h"
#include "apps/stability/sweep.h"
#include "gl/context.h"

namespace lw {

namespace {

using stability::CaseRange;
using stability::MethodReport;
using stability::Sweep;

constexpr double kNear_m = 0.05;
constexpr std::uint64_t kCases = 5000;
constexpr std::uint64_t kQuickCases = 500;
// GL on a processor is a hundred times slower.
constexpr std::uint64_t kGlShare = 25;

const char* name_of(CaseRange range) { return range == CaseRange::promised ? "promised" : "beyond"; }

std::vector<std::string> gl_methods() { return {"points:size_px=0", "compute", "mesh", "inverse-gl", "surface-gl"}; }

Result<std::vector<MethodReport>> sweep_of(const std::vector<std::string>& methods, CaseRange range,
                                           std::uint64_t first, std::uint64_t count) {
    Result<Sweep> sweep = Sweep::create(methods, range);
    if (!sweep) return sweep.error();
    for (std::uint64_t seed = first; seed < first + count; ++seed) sweep->run(seed);
    return sweep->reports();
}

void describe_methods(BenchOutput& output, CaseRange range, const std::vector<MethodReport>& reports) {
    std::vector<std::vector<std::string>> rows{{"method", "cases", "pixels compared", "place, px", "case",
                                                "depth, relative", "case", "wrong surface", "missing", "invented"}};
    for (const MethodReport& method : reports) {
        const stability::MethodErrors& e = method.errors;
        const std::string path = fmt::format("stability/{}/{}/", name_of(range), method.method);
        output.report.set(path + "cases", e.cases);
        output.report.set(path + "pixels", e.pixels);
        output.report.set(path + "place_px", e.place_px.value);
        output.report.set(path + "place_case", e.place_px.seed);
        output.report.set(path + "depth", e.depth.value);
        output.report.set(path + "depth_case", e.depth.seed);
        output.report.set(path + "wrong_surface", e.wrong_surface);
        output.report.set(path + "missing", e.missing);
        output.report.set(path + "invented", e.invented);
        output.report.set(path + "unusable", e.unusable);
        rows.push_back({method.method, std::to_string(e.cases), std::to_string(e.pixels),
                        fmt::format("{:.5f}", e.place_px.value), std::to_string(e.place_px.seed),
                        fmt::format("{:.1e}", e.depth.value), std::to_string(e.depth.seed),
                        std::to_string(e.wrong_surface), std::to_string(e.missing), std::to_string(e.invented)});
        output.csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", name_of(range), method.method, e.cases,
                                  e.pixels, e.place_px.value, e.place_px.seed, e.depth.value, e.depth.seed,
                                  e.wrong_surface, e.missing, e.invented);
        output.summary += fmt::format("{:<9} {}\n", name_of(range), stability::summary_of(method));
    }
    output.page.add_heading(range == CaseRange::promised ? "Largest errors in the promised range"
                                                         : "Largest errors beyond it");
    output.page.add_table(rows);
}

// --case.
std::optional<std::uint64_t> only_case(const Options& options) {
    const auto given = options.parameters.find("case");
    if (given == options.parameters.end()) return std::nullopt;
    return static_cast<std::uint64_t>(given->second);
}

Status run_sweeps(const Options& options, BenchOutput& output) {
    const std::optional<std::uint64_t> only = only_case(options);
    const std::uint64_t cases = only ? 1 : options.quick ? kQuickCases : kCases;
    const std::uint64_t first = only.value_or(0);
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (context) (*context)->make_current();
    for (const CaseRange range : {CaseRange::promised, CaseRange::beyond}) {
        Result<std::vector<MethodReport>> reports = sweep_of(stability::cpu_methods(), range, first, cases);
        if (!reports) return reports.error();
        if (context && range == CaseRange::promised) {
            const auto on_gl = sweep_of(gl_methods(), range, first, std::max<std::uint64_t>(1, cases / kGlShare));
            if (!on_gl) return on_gl.error();
            reports->insert(reports->end(), on_gl->begin(), on_gl->end());
        }
        describe_methods(output, range, *reports);
    }
    return Done{};
}

void add_depth_formats(BenchOutput& output) {
    using stability::DepthError;
    constexpr double kDistances_m[] = {0.1, 1.0, 10.0, 100.0, 1e3, 1e4, 1e5, 1e6, 1e7};
    SvgPlot plot{"Error of stored depth", "distance, m (near plane 0.05 m)", "relative error, worst"};
    plot.log_x = plot.log_y = true;
    std::vector<std::vector<std::string>> rows{{"format, worst relative error measured (predicted), and px"}};
    for (const double distance_m : kDistances_m) rows[0].push_back(short_number(distance_m) + " m");
    std::size_t style = 0;
    for (const stability::DepthFormat format : stability::depth_formats()) {
        const std::string name{stability::name_of(format)};
        SvgSeries measured{name, {}, {}, SvgMarks::points};
        SvgSeries predicted{"", {}, {}, SvgMarks::line};
        predicted.dashed = true;
        measured.style = predicted.style = style++;
        rows.push_back({name});
        for (const double distance_m : kDistances_m) {
            const DepthError error = stability::measure_depth_error(format, distance_m, kNear_m);
            measured.x.push_back(distance_m);
            measured.y.push_back(error.relative);
            predicted.x.push_back(distance_m);
            predicted.y.push_back(error.predicted_relative);
            rows.back().push_back(
                fmt::format("{:.1e} ({:.1e}), {:.1e} px", error.relative, error.predicted_relative, error.place_px));
            Report entry;
            entry.set("format", name);
            entry.set("distance_m", distance_m);
            entry.set("relative", error.relative);
            entry.set("predicted_relative", error.predicted_relative);
            entry.set("place_px", error.place_px);
            output.report.append("stability/depth_formats", entry);
        }
        plot.series.push_back(measured);
        plot.series.push_back(predicted);
    }
    output.page.add_plot(plot);
    output.page.add_paragraph("Points: measured. Dashed: half a step of the format over its slope.");
    output.page.add_table(rows);
    output.plots.emplace_back("depth_formats", plot);
}

void add_origin(const Options& options, BenchOutput& output) {
    SvgPlot plot{"Place of a sample, far from the world's origin", "camera from the origin, m", "worst error, px"};
    plot.log_x = plot.log_y = true;
    plot.series = {
        {"relative to the eye, double (ours)", {}, {}}, {"absolute, double", {}, {}}, {"absolute, float", {}, {}}};
    for (double distance_m = 1.0; distance_m <= 1e7; distance_m *= 10.0) {
        const stability::OriginErrors errors =
            stability::measure_origin_errors(distance_m, options.quick ? 2000 : 20000);
        const double values[] = {errors.ours_px, errors.absolute_double_px, errors.absolute_float_px};
        Report entry;
        entry.set("distance_m", distance_m);
        entry.set("ours_px", errors.ours_px);
        entry.set("absolute_double_px", errors.absolute_double_px);
        entry.set("absolute_float_px", errors.absolute_float_px);
        output.report.append("stability/origin", entry);
        for (std::size_t i = 0; i < 3; ++i) {
            plot.series[i].x.push_back(distance_m);
            plot.series[i].y.push_back(values[i]);
        }
    }
    output.page.add_plot(plot);
    output.plots.emplace_back("far_from_origin", plot);
}

}  // namespace

Result<BenchOutput> bench_stability(const Options& options) {
    BenchOutput output;
    output.page = HtmlReport{"latewarp bench: stability"};
    output.csv = "range,method,cases,pixels,place_px,place_case,depth,depth_case,wrong_surface,missing,invented\n";
    describe_machine(output.report, nullptr);
    const Status swept = run_sweeps(options, output);
    if (!swept) return swept.error();
    if (const std::optional<std::uint64_t> only = only_case(options)) {
        if (!options.out.empty()) {
            const Result<std::string> command = stability::save_case(*only, CaseRange::promised, options.out / "case");
            if (!command) return command.error();
            output.summary += *command + '\n';
        }
        return output;
    }
    add_depth_formats(output);
    add_origin(options, output);
    return output;
}

}  // namespace lw
