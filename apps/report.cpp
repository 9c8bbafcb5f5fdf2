#include "apps/report.h"

#include <unistd.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/image_io.h"

namespace lw {

using Json = nlohmann::ordered_json;

struct Report::Tree {
    Json root = Json::object();

    /// The value at `path`, made with its parents where it is missing.
    Json& at(std::string_view path) {
        Json* node = &root;
        while (true) {
            const std::size_t slash = path.find('/');
            node = &(*node)[std::string{path.substr(0, slash)}];
            if (slash == std::string_view::npos) return *node;
            path.remove_prefix(slash + 1);
        }
    }
};

namespace {

Json number_or_null(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of(const Distribution& d) {
    Json json = Json::object();
    json["mean"] = number_or_null(d.mean);
    json["min"] = number_or_null(d.min);
    json["p5"] = number_or_null(d.p5);
    json["p50"] = number_or_null(d.p50);
    json["p95"] = number_or_null(d.p95);
    json["p99"] = number_or_null(d.p99);
    json["max"] = number_or_null(d.max);
    return json;
}

}  // namespace

Report::Report() : tree_{std::make_unique<Tree>()} {}
Report::Report(Subcommand subcommand) : Report{} { set("schema", fmt::format("latewarp.{}/1", name_of(subcommand))); }
Report::Report(Report&&) noexcept = default;
Report& Report::operator=(Report&&) noexcept = default;
Report::~Report() = default;

void Report::set(std::string_view path, double number) { tree_->at(path) = number_or_null(number); }
void Report::set(std::string_view path, std::int64_t number) { tree_->at(path) = number; }
void Report::set(std::string_view path, std::uint64_t number) { tree_->at(path) = number; }
void Report::set(std::string_view path, bool flag) { tree_->at(path) = flag; }
void Report::set(std::string_view path, std::string_view text) { tree_->at(path) = std::string{text}; }
void Report::set(std::string_view path, glm::ivec2 size_px) { tree_->at(path) = {size_px.x, size_px.y}; }
void Report::set(std::string_view path, std::span<const double> numbers) {
    Json array = Json::array();
    for (const double number : numbers) array.push_back(number_or_null(number));
    tree_->at(path) = std::move(array);
}
void Report::set(std::string_view path, const std::vector<std::string>& texts) { tree_->at(path) = texts; }
void Report::set(std::string_view path, const Distribution& distribution) { tree_->at(path) = json_of(distribution); }
void Report::set(std::string_view path, const std::optional<double>& number) {
    tree_->at(path) = number ? number_or_null(*number) : Json(nullptr);
}
void Report::set(std::string_view path, const std::optional<Distribution>& maybe) {
    tree_->at(path) = maybe ? json_of(*maybe) : Json(nullptr);
}
void Report::set(std::string_view path, const Report& subtree) { tree_->at(path) = subtree.tree_->root; }
void Report::append(std::string_view path, const Report& element) {
    Json& array = tree_->at(path);
    if (!array.is_array()) array = Json::array();
    array.push_back(element.tree_->root);
}
void Report::set_null(std::string_view path) { tree_->at(path) = nullptr; }

std::string Report::text() const { return tree_->root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }
Status Report::write(const std::filesystem::path& path) const { return write_text(path, text()); }

void describe_machine(Report& report, const gl::Context* context) { describe_machine(report, machine_of(context)); }

void describe_machine(Report& report, const Machine& machine) {
    report.set("machine/cpu", machine.cpu);
    report.set("machine/cores", machine.cores);
    report.set_null("machine/gl_renderer");
    report.set_null("machine/gl_version");
    if (machine.gl_renderer.empty()) return;
    report.set("machine/gl_renderer", machine.gl_renderer);
    report.set("machine/gl_version", machine.gl_version);
}

void describe_scene(Report& report, const scene::Scene& scene) {
    report.set("scene/name", scene.name);
    report.set("scene/triangles", scene.triangle_count());
    report.set("scene/objects", static_cast<std::uint64_t>(scene.instances.size()));
    report.set("scene/movers", static_cast<std::uint64_t>(scene.movers.size()));
}

void describe_settings(Report& report, const Options& options) {
    const auto set = [&report](std::string_view key, const auto& value) {
        report.set(fmt::format("settings/{}", key), value);
    };
    set("scene", options.scene);
    for (const auto& [key, value] : options.parameters) set(fmt::format("param/{}", key), value);
    set("trace", options.trace);
    set("trace_start_s", options.trace_start_s);
    set("seconds", options.seconds);
    set("fov_deg", options.fov_deg);
    set("near_m", options.near_m);
    set("fill", options.fill);
    set("baselines", options.baselines);
    set("source_pose", options.source_pose == SourcePose::predicted ? "predicted" : "sampled");
    set("source_samples", options.source.samples_per_axis);
    set("source_density", options.source.density);
    if (options.source.guard_band_rad) {
        set("guard_band_deg", *options.source.guard_band_rad / kRadPerDeg);
    } else {
        set("guard_band_deg", "auto");
    }
    set("layers", options.source.layers);
    set("eyes", options.stereo.on ? "stereo" : "mono");
    if (options.stereo.on) {
        set("stereo", name_of(options.stereo.mode));
        set("ipd_mm", options.stereo.ipd_m * 1e3);
    }
    if (options.shells.on) {
        options.shells.shells == 0 ? set("shells", "auto") : set("shells", options.shells.shells);
        set("shell_samples", options.shells.samples_per_axis);
        set("shell_density", options.shells.density);
        set("max_age_s", options.shells.max_age_s);
    } else {
        set("shells", "off");
    }
    set("app_hz", options.app_hz);
    set("display_hz", options.display_hz);
    if (options.predict) set("predict", *options.predict);
    set("tracker_hz", options.tracker_hz);
    if (options.strips) set("strips", *options.strips);
    if (options.load.triangles > 0.0) set("load/triangles", options.load.triangles);
    if (options.load.stall_ms > 0.0) set("load/stall_ms", options.load.stall_ms);
    set("lead_ms", options.lead_ms);
    set("app_latency_ms", options.app_latency_ms);
    set("truth_samples", options.truth_samples);
    if (options.seed) set("seed", *options.seed);
    if (!options.chosen_because.empty()) set("chosen_because", options.chosen_because);
    report.set("method", options.method);
    report.set("size_px", options.size_px);
}

Status make_output_folder(const std::filesystem::path& folder) {
    std::error_code trouble;
    std::filesystem::create_directories(folder, trouble);
    if (!std::filesystem::is_directory(folder)) {
        return Error{"cannot make the output folder", folder.string(), "name a folder that can be made"};
    }
    if (access(folder.c_str(), W_OK | X_OK) != 0) {
        return Error{"cannot write into the output folder", folder.string(), "name a folder you may write to"};
    }
    return Done{};
}

Status check_output_file(const std::filesystem::path& path) {
    if (std::filesystem::is_directory(path)) return Error{"is a folder", path.string(), "name a file to write"};
    const std::filesystem::path parent = path.parent_path();
    const std::filesystem::path folder = parent.empty() ? std::filesystem::path{"."} : parent;
    if (!std::filesystem::is_directory(folder)) {
        return Error{"no such folder", folder.string(), "make it, or name another one"};
    }
    if (access(folder.c_str(), W_OK | X_OK) != 0) {
        return Error{"cannot write into the folder", folder.string(), "name a folder you may write to"};
    }
    return Done{};
}

Status write_text(const std::filesystem::path& path, std::string_view text) {
    return write_file_atomically(path, std::as_bytes(std::span{text.data(), text.size()}));
}

}  // namespace lw
