#include "apps/bench_point.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/image_io.h"

namespace lw {

namespace {

using Json = nlohmann::json;

Report report_of(const ImageErrors& errors) {
    Report report;
    report.set("flip", errors.flip);
    report.set("ssim", errors.ssim);
    report.set("psnr_db", errors.psnr_db);
    report.set("hole_fraction", errors.hole_fraction);
    return report;
}

void add_pairs(Report& report, const std::vector<PairErrors>& pairs) {
    for (const PairErrors& pair : pairs) {
        Report entry = report_of(pair.mean);
        entry.set("scene", pair.scene);
        entry.set("trace", pair.trace);
        report.append("pairs", entry);
    }
}

void set_conditions(Report& report, const BenchPoint& point) {
    report.set("size_px", point.conditions.size_px);
    report.set("settings/fill", point.fill);
    report.set("settings/frame_age_ms", point.conditions.frame_age_ms);
    report.set("settings/source_samples", point.conditions.source_samples);
    report.set("settings/source_density", point.conditions.source_density);
}

Report report_of(const BenchPoint& point) {
    Report report;
    report.set("method", point.method);
    set_conditions(report, point);
    report.set("warp_ms", point.warp_ms);
    report.set("warp_cpu_ms", point.warp_cpu_ms);
    report.set("prepare_ms", point.prepare_ms);
    report.set("memcpy_ratio", point.memcpy_ratio);
    const std::optional<ImageErrors> errors = point.errors();
    const auto set = [&](const char* key, double ImageErrors::*figure) {
        report.set(key, errors ? std::optional<double>{(*errors).*figure} : std::nullopt);
    };
    set("flip", &ImageErrors::flip);
    set("ssim", &ImageErrors::ssim);
    report.set("psnr_db", errors ? errors->psnr_db : std::nullopt);
    set("hole_fraction", &ImageErrors::hole_fraction);
    if (point.on_front) {
        report.set("on_front", *point.on_front);
    } else {
        report.set_null("on_front");
    }
    add_pairs(report, point.pairs);
    return report;
}

bool beats(const BenchPoint& a, const BenchPoint& b) {
    const double ms_a = a.warp_ms->p50;
    const double ms_b = b.warp_ms->p50;
    const double flip_a = a.errors()->flip;
    const double flip_b = b.errors()->flip;
    return ms_a <= ms_b && flip_a <= flip_b && (ms_a < ms_b || flip_a < flip_b);
}

std::optional<double> number_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? std::optional<double>{found->get<double>()} : std::nullopt;
}

ImageErrors errors_of(const Json& json) {
    ImageErrors errors;
    errors.flip = json.at("flip").get<double>();
    errors.ssim = json.at("ssim").get<double>();
    errors.psnr_db = number_at(json, "psnr_db");
    errors.hole_fraction = json.at("hole_fraction").get<double>();
    return errors;
}

std::optional<Distribution> distribution_at(const Json& json, const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_object()) return std::nullopt;
    const auto at = [&](const char* part) { return found->at(part).get<double>(); };
    return Distribution{at("mean"), at("min"), at("p5"), at("p50"), at("p95"), at("p99"), at("max")};
}

std::vector<PairErrors> pairs_of(const Json& json) {
    std::vector<PairErrors> pairs;
    if (!json.contains("pairs")) return pairs;
    for (const Json& pair : json.at("pairs")) {
        pairs.push_back({pair.at("scene").get<std::string>(), pair.at("trace").get<std::string>(), errors_of(pair)});
    }
    return pairs;
}

glm::ivec2 size_of(const Json& json) {
    return {json.at("size_px").at(0).get<int>(), json.at("size_px").at(1).get<int>()};
}

BenchPoint point_of(const Json& json) {
    BenchPoint point;
    const Json& settings = json.at("settings");
    point.method = json.at("method").get<std::string>();
    point.fill = settings.at("fill").get<std::string>();
    point.conditions = {size_of(json), settings.at("frame_age_ms").get<double>(),
                        settings.at("source_samples").get<int>(), settings.at("source_density").get<double>()};
    point.warp_ms = distribution_at(json, "warp_ms");
    point.warp_cpu_ms = number_at(json, "warp_cpu_ms");
    point.prepare_ms = number_at(json, "prepare_ms");
    point.memcpy_ratio = number_at(json, "memcpy_ratio");
    if (json.contains("on_front") && json.at("on_front").is_boolean()) point.on_front = json.at("on_front").get<bool>();
    point.pairs = pairs_of(json);
    return point;
}

BenchData data_of(const Json& json) {
    BenchData data;
    const Json& machine = json.at("machine");
    data.machine.cpu = machine.at("cpu").get<std::string>();
    data.machine.cores = machine.at("cores").get<int>();
    if (machine.at("gl_renderer").is_string()) data.machine.gl_renderer = machine.at("gl_renderer").get<std::string>();
    for (const Json& point : json.at("points")) data.points.push_back(point_of(point));
    data.processor_per_wall = number_at(json, "processor_per_wall");
    if (!json.contains("fresh")) return data;
    for (const Json& fresh : json.at("fresh")) {
        data.fresh.push_back({size_of(fresh), fresh.at("samples").get<int>(), pairs_of(fresh)});
    }
    return data;
}

}  // namespace

std::optional<ImageErrors> BenchPoint::errors() const {
    if (pairs.empty()) return std::nullopt;
    ImageErrors mean{0.0, 0.0, std::nullopt, 0.0};
    double psnr_sum = 0.0;
    int psnr_count = 0;
    const auto count = static_cast<double>(pairs.size());
    for (const PairErrors& pair : pairs) {
        mean.flip += pair.mean.flip / count;
        mean.ssim += pair.mean.ssim / count;
        mean.hole_fraction += pair.mean.hole_fraction / count;
        if (!pair.mean.psnr_db) continue;
        psnr_sum += *pair.mean.psnr_db;
        ++psnr_count;
    }
    if (psnr_count > 0) mean.psnr_db = psnr_sum / psnr_count;
    return mean;
}

bool is_same_setting(const BenchPoint& a, const BenchPoint& b) {
    return a.method == b.method && a.fill == b.fill && a.conditions == b.conditions;
}

void copy_times(const BenchPoint& from, BenchPoint& to) {
    to.warp_ms = from.warp_ms;
    to.warp_cpu_ms = from.warp_cpu_ms;
    to.prepare_ms = from.prepare_ms;
    to.memcpy_ratio = from.memcpy_ratio;
}

void mark_pareto_fronts(std::vector<BenchPoint>& points) {
    const auto competes = [](const BenchPoint& point) { return point.warp_ms && !point.pairs.empty(); };
    for (BenchPoint& point : points) {
        point.on_front.reset();
        if (!competes(point)) continue;
        point.on_front = std::none_of(points.begin(), points.end(), [&](const BenchPoint& other) {
            return competes(other) && other.conditions == point.conditions && beats(other, point);
        });
    }
}

void add_fresh(Report& report, const std::vector<FreshErrors>& fresh) {
    for (const FreshErrors& errors : fresh) {
        BenchPoint mean;
        mean.pairs = errors.pairs;
        Report entry = report_of(*mean.errors());
        entry.set("size_px", errors.size_px);
        entry.set("samples", errors.samples);
        add_pairs(entry, errors.pairs);
        report.append("fresh", entry);
    }
}

void add_points(Report& report, const std::vector<BenchPoint>& points) {
    for (const BenchPoint& point : points) report.append("points", report_of(point));
}

Result<BenchData> load_bench_data(const std::filesystem::path& path) {
    const auto bytes = read_file(path);
    if (!bytes) return bytes.error();
    const Error wrong{"not a report of the suite 'warp'", path.string(), "run latewarp bench --quick"};
    // A report is four levels deep; a hostile file could be nested until memory ends.
    const auto shallow = [](int depth, Json::parse_event_t, Json&) {
        if (depth > 16) throw std::length_error("nested too deeply");
        return true;
    };
    try {
        const Json json = Json::parse(bytes->begin(), bytes->end(), shallow);
        if (json.at("schema") != "latewarp.bench/1" || json.value("suite", "") != "warp") return wrong;
        return data_of(json);
    } catch (const std::exception&) {
        return wrong;
    }
}

}  // namespace lw
