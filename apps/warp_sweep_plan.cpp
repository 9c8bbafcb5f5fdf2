#include "apps/warp_sweep_plan.h"

#include <algorithm>
#include <string_view>

#include "warp_server/fill.h"

namespace lw {

namespace {

constexpr const char* kBaseFill = "nearest-background";
constexpr double kBaseAge_ms = 100.0;
constexpr int kBaseSize_px = 512;
constexpr int kBaseSamples = 2;

struct Recording {
    const char* file;
    const char* label;
    double start_s;  ///< the head moves from here on
};
// One calm, one fast, one scripted; each by another device.
constexpr Recording kRecordings[] = {
    {"head_traces/head_trajectory/real_world_head_movement_example_0.csv", "game", 20.0},
    {"head_traces/eyenavgs_rutgers/user113_truck.csv", "truck", 20.0},
    {"head_traces/questset/sample_movement_data.csv", "scripted", 20.0},
};
struct Model {
    const char* file;
    const char* label;
};
constexpr Model kModels[] = {
    {"gltf/home-theater/home-theater.gltf", "home-theater"},
    {"gltf/cube-room/cube-room.gltf", "cube-room"},
};

SweepPair pair_of(const std::string& scene, const std::string& label, const std::filesystem::path& data,
                  const Recording& recording) {
    return {scene, (data / recording.file).string(), recording.start_s, label, recording.label};
}

/// Three scenes and three traces: first each once, then the six other combinations, scene by scene.
std::vector<SweepPair> recorded_pairs(const std::filesystem::path& data, bool quick) {
    const auto scene = [&](std::size_t i) {
        return i == 0 ? std::string{"city"} : (data / kModels[i - 1].file).string();
    };
    const auto label = [&](std::size_t i) { return i == 0 ? "city" : kModels[i - 1].label; };
    std::vector<SweepPair> pairs;
    for (std::size_t i = 0; i < 3; ++i) pairs.push_back(pair_of(scene(i), label(i), data, kRecordings[i]));
    if (quick) return pairs;
    for (std::size_t i = 3; i-- > 0;) {
        for (std::size_t k = 1; k < 3; ++k)
            pairs.push_back(pair_of(scene(i), label(i), data, kRecordings[(i + k) % 3]));
    }
    return pairs;
}

std::vector<SweepPair> built_in_pairs() {
    std::vector<SweepPair> pairs;
    for (const char* trace : {"walk", "look-around", "shake"}) pairs.push_back({"city", trace, 5.0, "city", trace});
    return pairs;
}

bool has_recordings(const std::filesystem::path& data) {
    const auto exists = [&](const char* file) {
        std::error_code trouble;
        return std::filesystem::is_regular_file(data / file, trouble);
    };
    return std::all_of(std::begin(kRecordings), std::end(kRecordings),
                       [&](auto& entry) { return exists(entry.file); }) &&
           std::all_of(std::begin(kModels), std::end(kModels), [&](auto& entry) { return exists(entry.file); });
}

std::vector<WarpSetting> with_fill(const std::vector<std::string>& methods, const std::string& fill) {
    std::vector<WarpSetting> settings;
    for (const std::string& method : methods) settings.push_back({method, fill});
    return settings;
}

std::vector<WarpSetting> all_settings() {
    return with_fill({"stale", "rotation", "points:size_px=1", "points:size_px=2", "points:size_px=3", "points", "mesh",
                      "compute", "inverse-gl:steps=3", "surface-gl", "splat", "splat:threads=2", "inverse:steps=1",
                      "inverse:steps=3", "inverse:steps=5", "surface", "surface:threads=2"},
                     kBaseFill);
}

std::vector<WarpSetting> few_settings() {
    return with_fill({"stale", "rotation", "points:size_px=2", "mesh", "compute", "inverse-gl:steps=3", "surface-gl",
                      "splat", "inverse:steps=3", "surface"},
                     kBaseFill);
}

/// Where a GL method takes half a second on a software GL, the two that differ most stand for them.
std::vector<WarpSetting> costly_settings() {
    std::vector<WarpSetting> settings = few_settings();
    std::erase_if(settings, [](const WarpSetting& setting) {
        return setting.method == "compute" || setting.method.rfind("points", 0) == 0 ||
               setting.method.rfind("inverse-gl", 0) == 0;
    });
    return settings;
}

/// Around the base's frame age: one size of point stands for all, the CPU methods with all their settings.
std::vector<WarpSetting> cpu_settings() {
    std::vector<WarpSetting> settings = few_settings();
    for (const WarpSetting& more :
         with_fill({"inverse:steps=1", "inverse:steps=5", "splat:threads=2", "surface:threads=2"}, kBaseFill)) {
        settings.push_back(more);
    }
    return settings;
}

/// The fills that the base does not have, behind the methods whose holes differ.
void add_other_fills(std::vector<WarpSetting>& settings) {
    for (const std::string_view fill : fill_names()) {
        if (fill == kBaseFill) continue;
        for (const WarpSetting& setting : with_fill({"splat", "inverse:steps=3", "surface"}, std::string{fill})) {
            settings.push_back(setting);
        }
    }
}

void add_full_cells(SweepPlan& plan) {
    constexpr std::size_t kFrames = 4;
    const auto add = [&](int size_px, double age_ms, int samples, double density, std::vector<WarpSetting> settings,
                         std::size_t pairs, std::size_t frames) {
        plan.cells.push_back({{{size_px, size_px}, age_ms, samples, density}, std::move(settings), pairs, frames});
    };
    for (const double age_ms : {20.0, 50.0, 100.0, 200.0}) {
        for (const int samples : {1, 2, 4}) {
            const bool base = age_ms == kBaseAge_ms && samples == kBaseSamples;
            std::vector<WarpSetting> settings = age_ms == kBaseAge_ms ? all_settings() : cpu_settings();
            if (samples == kBaseSamples && age_ms >= kBaseAge_ms) add_other_fills(settings);
            add(kBaseSize_px, age_ms, samples, 1.0, settings, base ? plan.pairs.size() : plan.core_pairs, kFrames);
        }
    }
    for (const double density : {1.5, 2.0}) {
        for (const int samples : {1, 2}) {
            add(kBaseSize_px, kBaseAge_ms, samples, density, costly_settings(), plan.core_pairs, kFrames);
        }
    }
    add(1024, 20.0, kBaseSamples, 1.0, few_settings(), plan.core_pairs, 2);
    add(1024, kBaseAge_ms, kBaseSamples, 1.0, all_settings(), plan.core_pairs, 2);
    add(2048, kBaseAge_ms, kBaseSamples, 1.0, costly_settings(), plan.core_pairs, 1);
}

void add_quick_cells(SweepPlan& plan) {
    const auto add = [&](int size_px, double age_ms, int samples, std::vector<WarpSetting> settings,
                         std::size_t frames) {
        plan.cells.push_back(
            {{{size_px, size_px}, age_ms, samples, 1.0}, std::move(settings), plan.core_pairs, frames});
    };
    for (const double age_ms : {20.0, 100.0, 200.0}) {
        std::vector<WarpSetting> settings = few_settings();
        if (age_ms == kBaseAge_ms) add_other_fills(settings);
        add(kBaseSize_px, age_ms, kBaseSamples, settings, 2);
    }
    add(kBaseSize_px, kBaseAge_ms, 1, few_settings(), 2);
    add(1024, kBaseAge_ms, kBaseSamples, few_settings(), 1);
}

}  // namespace

std::size_t SweepPlan::point_count() const {
    std::size_t count = 0;
    for (const SweepCell& cell : cells) count += cell.settings.size();
    return count;
}

std::size_t SweepPlan::judgement_count() const {
    std::size_t count = 0;
    for (const SweepCell& cell : cells) count += cell.settings.size() * cell.pairs * cell.frames;
    return count;
}

SweepPlan warp_sweep_plan(bool quick, const std::filesystem::path& data) {
    SweepPlan plan;
    if (has_recordings(data)) {
        plan.pairs = recorded_pairs(data, quick);
    } else {
        plan.pairs = built_in_pairs();
        plan.warnings.push_back("no recorded traces and models at " + data.string() +
                                ": measuring the city along built-in traces (--data DIR says where they are)");
    }
    plan.core_pairs = 3;
    if (quick) {
        add_quick_cells(plan);
    } else {
        add_full_cells(plan);
    }
    return plan;
}

std::string picture_label(const std::string& specification) {
    const std::size_t colon = specification.find(':');
    if (colon == std::string::npos) return specification;
    std::string label = specification.substr(0, colon);
    std::size_t begin = colon + 1;
    char separator = ':';
    while (begin <= specification.size()) {
        const std::size_t end = std::min(specification.find(',', begin), specification.size());
        const std::string item = specification.substr(begin, end - begin);
        begin = end + 1;
        if (item.rfind("threads=", 0) == 0) continue;
        label += separator + item;
        separator = ',';
    }
    return label;
}

}  // namespace lw
