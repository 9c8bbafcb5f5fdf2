#include "apps/autotune.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "gl/context.h"
#include "warp_server/methods/registry.h"

namespace lw {

namespace {

constexpr const char* kMend = "run latewarp bench --quick";
/// Age of the frames where the options do not tell: one client period at 10 Hz.
constexpr double kUsualAge_ms = 100.0;

double pixels_of(const BenchConditions& conditions) {
    return static_cast<double>(conditions.size_px.x) * conditions.size_px.y;
}
double log_distance(double a, double b) { return std::abs(std::log(a / b)); }

/// The points of one method and fill for which `distance` is least.
template <class Distance>
std::vector<const BenchPoint*> nearest(const std::vector<const BenchPoint*>& points, Distance distance) {
    double least = std::numeric_limits<double>::infinity();
    for (const BenchPoint* point : points) least = std::min(least, distance(point->conditions));
    std::vector<const BenchPoint*> found;
    for (const BenchPoint* point : points) {
        if (distance(point->conditions) <= least) found.push_back(point);
    }
    return found;
}

/// Value at `x` on the polyline through `curve`, whose ends hold outside. Not empty.
double interpolated(const std::map<double, double>& curve, double x) {
    const auto above = curve.lower_bound(x);
    if (above == curve.begin()) return above->second;
    const auto below = std::prev(above);
    if (above == curve.end()) return below->second;
    const double part = (x - below->first) / (above->first - below->first);
    return below->second + part * (above->second - below->second);
}

std::optional<double> expected_ms(std::vector<const BenchPoint*> points, const BenchConditions& wanted) {
    std::erase_if(points, [](const BenchPoint* point) { return !point->warp_ms; });
    if (points.empty()) return std::nullopt;
    points = nearest(points, [&](const auto& c) { return log_distance(c.source_density, wanted.source_density); });
    points = nearest(points, [&](const auto& c) { return log_distance(c.frame_age_ms, wanted.frame_age_ms); });
    std::map<double, double> ms_of_pixels;
    for (const BenchPoint* point : points) ms_of_pixels[pixels_of(point->conditions)] = point->warp_ms->p50;
    const double pixels = pixels_of(wanted);
    const double measured = std::clamp(pixels, ms_of_pixels.begin()->first, ms_of_pixels.rbegin()->first);
    return interpolated(ms_of_pixels, pixels) * pixels / measured;
}

std::optional<double> expected_flip(std::vector<const BenchPoint*> points, const BenchConditions& wanted) {
    std::erase_if(points, [](const BenchPoint* point) { return point->pairs.empty(); });
    if (points.empty()) return std::nullopt;
    points = nearest(points, [&](const auto& c) { return log_distance(c.source_density, wanted.source_density); });
    points = nearest(points, [&](const auto& c) { return log_distance(c.source_samples, wanted.source_samples); });
    points = nearest(points, [&](const auto& c) { return log_distance(pixels_of(c), pixels_of(wanted)); });
    std::map<double, double> flip_of_age;
    for (const BenchPoint* point : points) flip_of_age[point->conditions.frame_age_ms] = point->errors()->flip;
    return interpolated(flip_of_age, wanted.frame_age_ms);
}

bool is_usable(const BenchPoint& point, const AutotuneRequest& request) {
    const MethodEntry* entry = find_warp_method(point.method);
    if (entry == nullptr || (entry->needs_gl && !request.gl_allowed)) return false;
    return !request.fill || point.fill == *request.fill;
}

/// One per method and fill that has a time and an error, in the order of the data.
std::vector<AutotuneChoice> candidates_of(const BenchData& data, const AutotuneRequest& request) {
    std::vector<std::pair<const BenchPoint*, std::vector<const BenchPoint*>>> groups;
    for (const BenchPoint& point : data.points) {
        if (!is_usable(point, request)) continue;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& other) {
            return other.first->method == point.method && other.first->fill == point.fill;
        });
        if (group == groups.end()) group = groups.insert(groups.end(), {&point, {}});
        group->second.push_back(&point);
    }
    std::vector<AutotuneChoice> candidates;
    for (const auto& [first, points] : groups) {
        const std::optional<double> ms = expected_ms(points, request.conditions);
        const std::optional<double> flip = expected_flip(points, request.conditions);
        if (ms && flip) candidates.push_back({first->method, first->fill, *ms, *flip, true, {}});
    }
    return candidates;
}

bool is_cheaper(const AutotuneChoice& a, const AutotuneChoice& b) {
    return a.warp_ms != b.warp_ms ? a.warp_ms < b.warp_ms : a.flip < b.flip;
}
bool is_better(const AutotuneChoice& a, const AutotuneChoice& b) {
    return a.flip != b.flip ? a.flip < b.flip : a.warp_ms < b.warp_ms;
}

std::string reason_of(const AutotuneChoice& choice, const AutotuneRequest& request, std::size_t fitting,
                      std::size_t all) {
    const std::string limit = request.error_cap ? fmt::format("FLIP at most {:g}", *request.error_cap)
                                                : fmt::format("at most {:g} ms", *request.budget_ms);
    std::string why;
    if (choice.met) {
        why = fmt::format("the {} of {} with {}", request.error_cap ? "cheapest" : "most exact", fitting, limit);
    } else {
        why =
            fmt::format("none of {} has {}, this is the {}", all, limit, request.error_cap ? "most exact" : "cheapest");
    }
    const BenchConditions& c = request.conditions;
    return fmt::format(
        "{} with fill {}: {}; expected FLIP {:.4f} in {:.2f} ms for {}x{} pixels, frames {:.0f} ms old, "
        "{}x{} samples, density {:g}",
        choice.method, choice.fill, why, choice.flip, choice.warp_ms, c.size_px.x, c.size_px.y, c.frame_age_ms,
        c.source_samples, c.source_samples, c.source_density);
}

bool is_live(Subcommand subcommand) { return subcommand == Subcommand::demo || subcommand == Subcommand::measure; }

/// In replay the frame published last is one to two client periods old; live and for a single frame there is no
/// telling.
double frame_age_ms_of(const Options& options) {
    if (options.subcommand != Subcommand::replay) return kUsualAge_ms;
    const double period_ms = 1000.0 / options.app_hz.value_or(10.0);
    return options.app_latency_ms.value_or(period_ms) + 0.5 * period_ms;
}

AutotuneRequest request_of(const Options& options, const Machine& machine) {
    AutotuneRequest request;
    request.error_cap = options.error_cap;
    request.budget_ms = options.budget_ms;
    request.conditions = {options.size_px, frame_age_ms_of(options), options.source.samples_per_axis,
                          options.source.density};
    if (options.fill_given) request.fill = options.fill;
    const bool has_gpu = !machine.gl_renderer.empty() && !gl::is_software_renderer(machine.gl_renderer);
    request.gl_allowed = has_gpu || (!is_live(options.subcommand) && !machine.gl_renderer.empty());
    return request;
}

Result<BenchData> measured_data(const Options& options, const Machine& machine) {
    const std::filesystem::path path = options.bench_data.empty() ? measured_data_path() : options.bench_data;
    std::error_code trouble;
    if (!std::filesystem::is_regular_file(path, trouble)) {
        return Error{"no measured data for --method auto", path.string(), kMend};
    }
    Result<BenchData> data = load_bench_data(path);
    if (!data || is_same_machine(data->machine, machine)) return data;
    return Error{fmt::format("measured on another machine ({})", text_of(data->machine)), path.string(), kMend};
}

}  // namespace

Result<AutotuneChoice> choose_method(const BenchData& data, const AutotuneRequest& request) {
    std::vector<AutotuneChoice> candidates = candidates_of(data, request);
    if (candidates.empty()) return Error{"no method was measured with time and error", "--method auto", kMend};
    const bool capped = request.error_cap.has_value();
    const auto fits = [&](const AutotuneChoice& choice) {
        return capped ? choice.flip <= *request.error_cap : choice.warp_ms <= *request.budget_ms;
    };
    const std::size_t all = candidates.size();
    std::vector<AutotuneChoice> fitting;
    std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(fitting), fits);
    const bool met = !fitting.empty();
    const std::vector<AutotuneChoice>& from = met ? fitting : candidates;
    // Where nothing fits, the limit itself is what to come near to.
    const bool by_cost = capped == met;
    AutotuneChoice choice = *std::min_element(from.begin(), from.end(), by_cost ? is_cheaper : is_better);
    choice.met = met;
    choice.reason = reason_of(choice, request, fitting.size(), all);
    return choice;
}

std::filesystem::path measured_data_path() {
    const auto folder = [](const char* variable) {
        const char* value = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets variables here
        return std::filesystem::path{value == nullptr ? "" : value};
    };
    if (const auto cache = folder("XDG_CACHE_HOME"); cache.is_absolute()) return cache / "latewarp" / "bench.json";
    if (const auto home = folder("HOME"); home.is_absolute()) return home / ".cache" / "latewarp" / "bench.json";
    return {};
}

Result<Options> with_chosen_method(const Options& options) {
    if (options.method != "auto") return options;
    const Machine machine = this_machine();
    const Result<BenchData> data = measured_data(options, machine);
    if (!data) return data.error();
    const Result<AutotuneChoice> choice = choose_method(*data, request_of(options, machine));
    if (!choice) return choice.error();
    if (!options.quiet) std::fprintf(stderr, "latewarp: auto: %s\n", choice->reason.c_str());
    Options chosen = options;
    chosen.method = choice->method;
    chosen.fill = choice->fill;
    chosen.chosen_because = choice->reason;
    return chosen;
}

}  // namespace lw
