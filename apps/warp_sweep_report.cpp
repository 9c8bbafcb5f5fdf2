#include "apps/warp_sweep_report.h"

#include <algorithm>
#include <map>
#include <set>

namespace lw {

namespace {

constexpr glm::ivec2 kBaseSize_px{512, 512};
constexpr double kBaseAge_ms = 100.0;
constexpr int kBaseSamples = 2;
constexpr const char* kBaseFill = "nearest-background";

/// Equal methods look equal in every plot.
std::size_t style_of(const std::string& method) {
    static const std::vector<std::string> known = {"surface",
                                                   "splat",
                                                   "rotation",
                                                   "inverse:steps=3",
                                                   "mesh",
                                                   "stale",
                                                   "compute",
                                                   "surface-gl",
                                                   "points:size_px=2",
                                                   "inverse-gl:steps=3",
                                                   "points:size_px=1",
                                                   "points:size_px=3",
                                                   "points",
                                                   "inverse:steps=1",
                                                   "inverse:steps=5",
                                                   "splat:threads=2",
                                                   "surface:threads=2"};
    const auto found = std::find(known.begin(), known.end(), method);
    return static_cast<std::size_t>(found - known.begin());
}

bool has_base_fill(const BenchPoint& point) { return point.fill == kBaseFill; }

/// Mean FLIP over the pairs that all cells have, so that curves over cells compare equal things.
std::optional<double> core_flip(const SweepPlan& plan, std::vector<PairErrors> pairs) {
    if (pairs.empty()) return std::nullopt;
    pairs.resize(std::min(pairs.size(), plan.core_pairs));
    double sum = 0.0;
    for (const PairErrors& pair : pairs) sum += pair.mean.flip;
    return sum / static_cast<double>(pairs.size());
}

/// The methods of the points that `wanted` accepts, in the order of the styles.
template <class Wanted>
std::vector<std::string> methods_of(const std::vector<BenchPoint>& points, Wanted wanted) {
    std::vector<std::string> methods;
    for (const BenchPoint& point : points) {
        if (!wanted(point)) continue;
        if (std::find(methods.begin(), methods.end(), point.method) == methods.end()) methods.push_back(point.method);
    }
    std::stable_sort(methods.begin(), methods.end(),
                     [](const std::string& a, const std::string& b) { return style_of(a) < style_of(b); });
    return methods;
}

/// The front as one curve, from the fastest to the best.
SvgSeries front_curve(const std::vector<const BenchPoint*>& points) {
    std::map<double, double> front;
    for (const BenchPoint* point : points) {
        if (point->on_front.value_or(false)) front[point->warp_ms->p50] = point->errors()->flip;
    }
    SvgSeries series{"Pareto front", {}, {}, SvgMarks::line, true, 5};
    for (const auto& [ms, flip] : front) {
        series.x.push_back(ms);
        series.y.push_back(flip);
    }
    return series;
}

SvgPlot front_plot(const BenchConditions& conditions, const std::vector<const BenchPoint*>& points,
                   const std::vector<FreshErrors>& fresh) {
    SvgPlot plot{"Run time against error: " + text_of(conditions), "warp and fill, ms (median)", "FLIP, mean"};
    plot.log_x = true;
    plot.y_from_zero = true;
    plot.series.push_back(front_curve(points));
    double least_ms = 1e300;
    double most_ms = 0.0;
    std::vector<const BenchPoint*> ordered = points;
    std::stable_sort(ordered.begin(), ordered.end(), [](const BenchPoint* a, const BenchPoint* b) {
        return style_of(a->method) < style_of(b->method);
    });
    for (const BenchPoint* point : ordered) {
        least_ms = std::min(least_ms, point->warp_ms->p50);
        most_ms = std::max(most_ms, point->warp_ms->p50);
        const std::string label = has_base_fill(*point) ? point->method : point->method + ", fill " + point->fill;
        plot.series.push_back({label,
                               {point->warp_ms->p50},
                               {point->errors()->flip},
                               SvgMarks::points,
                               false,
                               style_of(point->method) + (has_base_fill(*point) ? 0 : 17)});
    }
    for (const FreshErrors& errors : fresh) {
        if (errors.size_px != conditions.size_px) continue;
        if (errors.samples != 1 && errors.samples != conditions.source_samples) continue;
        BenchPoint mean;
        mean.pairs = errors.pairs;
        mean.pairs.resize(std::min(mean.pairs.size(), points.front()->pairs.size()));
        const double flip = mean.errors()->flip;
        const std::string label = fmt::format("zero latency, {0}x{0} samples", errors.samples);
        plot.series.push_back({label,
                               {least_ms, most_ms},
                               {flip, flip},
                               SvgMarks::line,
                               true,
                               errors.samples == 1 ? std::size_t{1} : std::size_t{3}});
    }
    plot.height_px = std::max(360.0, 70.0 + 18.0 * static_cast<double>(plot.series.size()));
    return plot;
}

std::string front_name(const BenchConditions& conditions) {
    return fmt::format("front-{}px-{:g}ms-{}x{}-density{:g}", conditions.size_px.y, conditions.frame_age_ms,
                       conditions.source_samples, conditions.source_samples, conditions.source_density);
}

void add_front_plots(const std::vector<BenchPoint>& points, const std::vector<FreshErrors>& fresh,
                     std::vector<std::pair<std::string, SvgPlot>>& plots) {
    std::vector<BenchConditions> done;
    for (const BenchPoint& first : points) {
        const BenchConditions& conditions = first.conditions;
        if (conditions.frame_age_ms != kBaseAge_ms) continue;
        if (std::find(done.begin(), done.end(), conditions) != done.end()) continue;
        done.push_back(conditions);
        std::vector<const BenchPoint*> group;
        for (const BenchPoint& point : points) {
            if (point.conditions == conditions && point.on_front) group.push_back(&point);
        }
        if (!group.empty()) plots.emplace_back(front_name(conditions), front_plot(conditions, group, fresh));
    }
}

void add_age_plot(const SweepPlan& plan, const std::vector<BenchPoint>& points,
                  std::vector<std::pair<std::string, SvgPlot>>& plots) {
    const auto wanted = [](const BenchPoint& point) {
        return point.conditions.size_px == kBaseSize_px && point.conditions.source_samples == kBaseSamples &&
               point.conditions.source_density == 1.0 && has_base_fill(point) && !point.pairs.empty() &&
               picture_label(point.method) == point.method;
    };
    SvgPlot plot{"Error against frame age: 512x512, 2x2 samples", "frame age, ms", "FLIP, mean"};
    plot.x_from_zero = true;
    plot.y_from_zero = true;
    for (const std::string& method : methods_of(points, wanted)) {
        SvgSeries series{method, {}, {}, SvgMarks::both, false, style_of(method)};
        std::map<double, double> curve;
        for (const BenchPoint& point : points) {
            if (wanted(point) && point.method == method) {
                curve[point.conditions.frame_age_ms] = *core_flip(plan, point.pairs);
            }
        }
        for (const auto& [age_ms, flip] : curve) {
            series.x.push_back(age_ms);
            series.y.push_back(flip);
        }
        plot.series.push_back(std::move(series));
    }
    plot.height_px = 420.0;
    if (!plot.series.empty()) plots.emplace_back("age", std::move(plot));
}

void add_size_plot(const std::vector<BenchPoint>& points, std::vector<std::pair<std::string, SvgPlot>>& plots) {
    const auto wanted = [](const BenchPoint& point) {
        return point.conditions.frame_age_ms == kBaseAge_ms && point.conditions.source_samples == kBaseSamples &&
               point.conditions.source_density == 1.0 && has_base_fill(point) && point.warp_ms;
    };
    SvgPlot plot{"Run time against size, frames 100 ms old", "pixels of the display, millions",
                 "warp and fill, ms (median)"};
    plot.log_x = true;
    plot.log_y = true;
    for (const std::string& method : methods_of(points, wanted)) {
        SvgSeries series{method, {}, {}, SvgMarks::both, false, style_of(method)};
        std::map<double, double> curve;
        for (const BenchPoint& point : points) {
            if (!wanted(point) || point.method != method) continue;
            const glm::dvec2 size_px{point.conditions.size_px};
            curve[size_px.x * size_px.y * 1e-6] = point.warp_ms->p50;
        }
        for (const auto& [pixels, ms] : curve) {
            series.x.push_back(pixels);
            series.y.push_back(ms);
        }
        plot.series.push_back(std::move(series));
    }
    plot.height_px = 420.0;
    if (!plot.series.empty()) plots.emplace_back("size", std::move(plot));
}

std::string number(const std::optional<double>& value) { return value ? short_number(*value) : "-"; }

std::vector<std::string> table_row(const BenchPoint& point) {
    const std::optional<ImageErrors> errors = point.errors();
    const auto error = [&](double ImageErrors::*figure) { return errors ? short_number((*errors).*figure) : "-"; };
    return {point.method,
            point.fill,
            point.warp_ms ? short_number(point.warp_ms->p50) : "-",
            point.warp_ms ? short_number(point.warp_ms->p99) : "-",
            number(point.memcpy_ratio),
            number(point.prepare_ms),
            error(&ImageErrors::flip),
            error(&ImageErrors::ssim),
            errors ? number(errors->psnr_db) : "-",
            error(&ImageErrors::hole_fraction),
            point.on_front.value_or(false) ? "front" : ""};
}

std::string csv_number(const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; }

std::string csv_field(const std::string& text) {
    return text.find(',') == std::string::npos ? text : fmt::format("\"{}\"", text);
}

std::string csv_row(const BenchPoint& point, const std::string& scene, const std::string& trace,
                    const std::optional<ImageErrors>& errors) {
    const BenchConditions& c = point.conditions;
    const auto error = [&](double ImageErrors::*figure) { return errors ? fmt::format("{}", (*errors).*figure) : ""; };
    const auto quantile = [&](double Distribution::*figure) {
        return point.warp_ms ? fmt::format("{}", (*point.warp_ms).*figure) : "";
    };
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", csv_field(point.method),
                       point.fill, c.size_px.x, c.size_px.y, c.frame_age_ms, c.source_samples, c.source_density,
                       csv_field(scene), csv_field(trace), quantile(&Distribution::p50), quantile(&Distribution::p99),
                       csv_number(point.warp_cpu_ms), csv_number(point.memcpy_ratio), csv_number(point.prepare_ms),
                       error(&ImageErrors::flip), error(&ImageErrors::ssim), errors ? csv_number(errors->psnr_db) : "",
                       error(&ImageErrors::hole_fraction), point.on_front ? (*point.on_front ? "1" : "0") : "");
}

}  // namespace

std::string text_of(const BenchConditions& c) {
    return fmt::format("{}x{}, {:g} ms, {}x{} samples, density {:g}", c.size_px.x, c.size_px.y, c.frame_age_ms,
                       c.source_samples, c.source_samples, c.source_density);
}

std::vector<std::pair<std::string, SvgPlot>> warp_sweep_plots(const SweepPlan& plan,
                                                              const std::vector<BenchPoint>& points,
                                                              const std::vector<FreshErrors>& fresh) {
    std::vector<std::pair<std::string, SvgPlot>> plots;
    add_front_plots(points, fresh, plots);
    add_age_plot(plan, points, plots);
    add_size_plot(points, plots);
    return plots;
}

std::string warp_sweep_csv(const std::vector<BenchPoint>& points) {
    std::string csv =
        "method,fill,width_px,height_px,frame_age_ms,source_samples,source_density,scene,trace,warp_ms_p50,warp_ms_p99,"
        "warp_cpu_ms,memcpy_ratio,prepare_ms,flip,ssim,psnr_db,hole_fraction,on_front\n";
    for (const BenchPoint& point : points) {
        csv += csv_row(point, "all", "all", point.errors());
        for (const PairErrors& pair : point.pairs) csv += csv_row(point, pair.scene, pair.trace, pair.mean);
    }
    return csv;
}

HtmlReport warp_sweep_page(const SweepPlan& plan, const std::vector<BenchPoint>& points,
                           const std::vector<std::pair<std::string, SvgPlot>>& plots, const std::string& machine) {
    HtmlReport page{"Latewarp bench: run time against error"};
    std::string pairs;
    for (const SweepPair& pair : plan.pairs) {
        pairs += fmt::format("{}{} along {}", pairs.empty() ? "" : ", ", pair.scene_label, pair.trace_label);
    }
    page.add_paragraph(fmt::format(
        "{}. {} points; the errors are means over pictures from: {} (the first {} only, but at 512x512, 100 ms and 2x2 "
        "samples). Truth with {}x{} samples per pixel; 90 degrees high. Times: the first of these pairs, warp and "
        "fill, "
        "one thread unless the method says otherwise, beside a memcpy of the source's colour and depth in the same "
        "run.",
        machine, points.size(), pairs, plan.core_pairs, plan.truth_samples, plan.truth_samples));
    for (const auto& [name, plot] : plots) page.add_plot(plot);
    std::vector<BenchConditions> done;
    for (const BenchPoint& first : points) {
        if (std::find(done.begin(), done.end(), first.conditions) != done.end()) continue;
        done.push_back(first.conditions);
        page.add_heading(text_of(first.conditions));
        std::vector<std::vector<std::string>> rows = {
            {"method", "fill", "warp, ms", "p99", "/ memcpy", "prepare, ms", "FLIP", "SSIM", "PSNR, dB", "holes", ""}};
        for (const BenchPoint& point : points) {
            if (point.conditions == first.conditions) rows.push_back(table_row(point));
        }
        page.add_table(rows);
    }
    return page;
}

}  // namespace lw
