#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <tuple>

#include "apps/progress.h"
#include "apps/warp_sweep_run.h"
#include "apps/warp_sweep_stage.h"
#include "core/stopwatch.h"
#include "warp_server/frame_warper.h"

namespace lw {

namespace {

constexpr std::size_t kSources = 3;
constexpr int kWarmUp = 3;
constexpr int kPrepares = 7;

struct Took {
    double wall_ms = 0.0;
    double processor_ms = 0.0;
};

template <class Work>
Took timed(Work work) {
    const ProcessorStopwatch processor;
    const Stopwatch wall;
    work();
    return {wall.ms(), processor.ms()};
}

double median(std::vector<double> values) { return distribution_of(values)->p50; }

struct Times {
    Distribution warp_ms;
    double warp_cpu_ms = 0.0;
    std::optional<double> prepare_ms;
    double memcpy_ratio = 0.0;
    double busy = 0.0;  ///< processor time per wall time
};

/// Sources of one kind at several moments, as a server would meet them one after another.
struct Source {
    std::shared_ptr<Layer> layer;
    Camera target;
    std::vector<ObjectTransform> movers;
    CpuPixels copy;  ///< where the source is copied to
};

std::vector<Source> sources_of(const SweepPlan& plan, const BenchConditions& conditions, SweepStage& stage) {
    BenchConditions cheap = conditions;
    cheap.source_samples = 1;
    std::vector<Source> sources(kSources);
    for (std::size_t i = 0; i < kSources; ++i) {
        const double photon_s = photon_s_of(plan, i);
        sources[i].layer = stage.source(cheap, photon_s);
        sources[i].target = stage.target_camera(conditions.size_px, photon_s);
        sources[i].movers = stage.target_movers(photon_s);
        sources[i].copy.colour.resize(sources[i].layer->camera.size_px);
        sources[i].copy.depth.resize(sources[i].layer->camera.size_px);
    }
    return sources;
}

void copy_pixels(Source& source) {
    const CpuPixels& from = source.layer->cpu();
    std::memcpy(source.copy.colour.pixels().data(), from.colour.pixels().data(), from.colour.size_bytes());
    std::memcpy(source.copy.depth.pixels().data(), from.depth.pixels().data(), from.depth.size_bytes());
}

std::optional<double> prepare_ms(const FrameWarper& warper, std::vector<Source>& sources) {
    std::vector<double> took_ms;
    for (int i = 0; i < kPrepares; ++i) {
        Layer& layer = *sources[static_cast<std::size_t>(i) % kSources].layer;
        took_ms.push_back(timed([&] { warper.prepare(layer); }).wall_ms);
        if (layer.prepared_for(warper.method().label()) == nullptr) return std::nullopt;
    }
    return median(took_ms);
}

Times times_of(FrameWarper& warper, std::vector<Source>& sources, int repeats) {
    Times times;
    times.prepare_ms = prepare_ms(warper, sources);
    std::vector<double> warp_ms;
    std::vector<double> warp_cpu_ms;
    std::vector<double> copy_ms;
    for (int i = -kWarmUp; i < repeats; ++i) {
        const auto turn = static_cast<std::size_t>(i + kWarmUp);
        Source& copied = sources[(turn + 1) % kSources];
        const Source& source = sources[turn % kSources];
        const RenderedFrame frame{1, {source.layer}, {}};
        const Took copy = timed([&] { copy_pixels(copied); });
        const Took warp = timed([&] { (void)warper.warp(frame, {source.target, source.movers}); });
        if (i < 0) continue;
        copy_ms.push_back(copy.wall_ms);
        warp_ms.push_back(warp.wall_ms);
        warp_cpu_ms.push_back(warp.processor_ms);
    }
    times.warp_ms = *distribution_of(warp_ms);
    times.warp_cpu_ms = median(warp_cpu_ms);
    times.memcpy_ratio = times.warp_ms.p50 / median(copy_ms);
    times.busy = times.warp_cpu_ms / times.warp_ms.p50;
    return times;
}

/// What the run time depends on, of conditions: all but the samples.
BenchConditions timed_as(BenchConditions conditions) {
    conditions.source_samples = 1;
    return conditions;
}

struct Task {
    WarpSetting setting;
    BenchConditions conditions;
    std::vector<BenchPoint*> points;  ///< that share the measurement
};

/// In the order of the points, so that tasks of equal conditions are neighbours more often than not.
std::vector<Task> tasks_of(std::vector<BenchPoint>& points) {
    std::vector<Task> tasks;
    for (BenchPoint& point : points) {
        if (point.warp_ms) continue;
        const WarpSetting setting{point.method, point.fill};
        const BenchConditions conditions = timed_as(point.conditions);
        auto task = std::find_if(tasks.begin(), tasks.end(), [&](const Task& other) {
            return other.setting == setting && other.conditions == conditions;
        });
        if (task == tasks.end()) task = tasks.insert(tasks.end(), {setting, conditions, {}});
        task->points.push_back(&point);
    }
    std::stable_sort(tasks.begin(), tasks.end(), [](const Task& a, const Task& b) {
        const auto key = [](const BenchConditions& c) {
            return std::tuple{c.size_px.x, c.frame_age_ms, c.source_density};
        };
        return key(a.conditions) < key(b.conditions);
    });
    return tasks;
}

void keep(const Times& times, const Task& task) {
    for (BenchPoint* point : task.points) {
        point->warp_ms = times.warp_ms;
        point->warp_cpu_ms = times.warp_cpu_ms;
        point->prepare_ms = times.prepare_ms;
        point->memcpy_ratio = times.memcpy_ratio;
    }
}

/// Methods that do all their work on the calling thread: their processor time tells whether the machine was quiet.
bool is_single_threaded(const WarpSetting& setting) {
    return setting.method == "splat" || setting.method == "rotation" || setting.method.rfind("inverse:", 0) == 0;
}

}  // namespace

std::vector<BenchPoint> points_of(const SweepPlan& plan) {
    std::vector<BenchPoint> points;
    for (const SweepCell& cell : plan.cells) {
        for (const WarpSetting& setting : cell.settings) {
            BenchPoint point;
            point.method = setting.method;
            point.fill = setting.fill;
            point.conditions = cell.conditions;
            points.push_back(std::move(point));
        }
    }
    return points;
}

Result<std::optional<double>> measure_times(const SweepPlan& plan, const SweepSettings& settings, int repeats,
                                            std::vector<BenchPoint>& points) {
    Result<SweepStage> stage = SweepStage::create(plan.pairs.front(), std::nullopt);
    if (!stage) return stage.error();
    const std::vector<Task> tasks = tasks_of(points);
    if (tasks.empty()) return std::optional<double>{};
    Progress progress{"times", tasks.size(), settings.quiet};
    std::vector<Source> sources;
    std::vector<double> busy;
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        const std::chrono::duration<double> gone = std::chrono::steady_clock::now() - begin;
        if (gone.count() > settings.most_s) break;
        const Task& task = tasks[i];
        if (i == 0 || !(task.conditions == tasks[i - 1].conditions)) {
            sources = sources_of(plan, task.conditions, *stage);
        }
        Result<FrameWarper> warper = FrameWarper::create(task.setting.method, task.setting.fill);
        if (!warper) return warper.error();
        const Times times = times_of(*warper, sources, repeats);
        keep(times, task);
        if (is_single_threaded(task.setting)) busy.push_back(times.busy);
        for (Source& source : sources) source.layer->prepared.clear();
        progress.show(i + 1);
    }
    return busy.empty() ? std::nullopt : std::optional<double>{median(busy)};
}

}  // namespace lw
