/// What deciding what to draw costs, stage by stage, in the town of 20,000 buildings from its street: medians along a
/// short walk, with cold caches; processor time of the thread, for two threads that of the clock.
///   occluders  what hides is drawn into the occlusion buffer
///   objects    boxes follow what moves, and those in view and not hidden are found; with the occluders
///   clusters   those of the objects found are tested, and the draws are listed
///   all        what a frame does before it draws

#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <memory>
#include <vector>

#include "bench/run_benchmarks.h"
#include "client_renderer/culling.h"
#include "client_renderer/gpu_scene.h"
#include "core/check.h"
#include "gl/context.h"
#include "scene/built_in.h"

namespace lw::bench {
namespace {

constexpr int kFrames = 201;
// None, as where `latewarp bench --suite skip` times frames.
constexpr double kRevealMargin_m = 0.0;

double ms_of(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
}
double thread_ms() { return ms_of(CLOCK_THREAD_CPUTIME_ID); }
double clock_ms() { return ms_of(CLOCK_MONOTONIC); }

/// A scene and what culls it.
struct Stage {
    scene::Scene scene;
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<GpuScene> gpu_scene;
    std::unique_ptr<scene::SceneState> state;
    std::unique_ptr<PlacedInstances> placed;
    std::unique_ptr<TaskPool> two_threads;
    std::unique_ptr<Culling> culling;
    std::unique_ptr<Culling> culling_by_two;
    std::unique_ptr<Occluders> occluders;
    std::unique_ptr<DrawList> draws;
};

Stage& stage() {
    static const std::unique_ptr<Stage> made = [] {
        auto made_stage = std::make_unique<Stage>();
        Stage& s = *made_stage;
        auto scene = scene::make_built_in("city", {{"buildings", 20000.0}});
        LW_CHECK(scene.ok(), "the town can be made");
        s.scene = std::move(*scene);
        auto context = gl::Context::create();
        LW_CHECK(context.ok(), "a GL context can be made");
        s.context = std::move(*context);
        s.context->make_current();
        auto gpu_scene = GpuScene::create(s.scene);
        LW_CHECK(gpu_scene.ok(), "the town's shaders compile");
        s.gpu_scene = std::move(*gpu_scene);
        s.state = std::make_unique<scene::SceneState>(s.scene);
        s.state->set_time(0.0);
        s.placed = std::make_unique<PlacedInstances>(s.scene, *s.state);
        CullingSettings settings;
        settings.reveal_margin_m = kRevealMargin_m;
        s.two_threads = std::make_unique<TaskPool>(2, 10000);
        s.culling_by_two = std::make_unique<Culling>(*s.placed, settings, s.two_threads.get());
        s.culling = std::make_unique<Culling>(*s.placed, settings);
        s.occluders = std::make_unique<Occluders>(*s.placed);
        s.draws = std::make_unique<DrawList>(*s.placed);
        return made_stage;
    }();
    return *made;
}

Camera camera_at(const scene::Scene& scene, int frame) {
    Camera camera;
    camera.size_px = {1024, 1024};
    camera.fov = FovTangents::symmetric(1.5707963267948966, 1.0);
    camera.world_from_eye = scene.start_pose.value_or(Pose{});
    camera.world_from_eye.position_m += camera.world_from_eye.orientation * glm::dvec3{0.0, 0.0, -0.01 * frame};
    return camera;
}

/// As drawing the frame before does.
void forget_caches() {
    static std::vector<std::uint64_t> other(std::size_t{1} << 23);
    for (std::uint64_t& value : other) ++value;
    benchmark::DoNotOptimize(other.data());
}

void run(benchmark::State& state, const std::function<double(const Camera&)>& ms_of_frame) {
    std::vector<double> times_ms;
    int frame = 0;
    for ([[maybe_unused]] auto _ : state) {
        forget_caches();
        const double ms = ms_of_frame(camera_at(stage().scene, frame++));
        times_ms.push_back(ms);
        state.SetIterationTime(1e-3 * ms);
    }
    const auto middle = times_ms.begin() + static_cast<std::ptrdiff_t>(times_ms.size() / 2);
    std::nth_element(times_ms.begin(), middle, times_ms.end());
    state.counters["median_ms"] = *middle;
    state.counters["min_ms"] = *std::min_element(times_ms.begin(), times_ms.end());
    const ClusterCounters& clusters = stage().draws->cluster_counters();
    state.counters["objects"] = static_cast<double>(stage().draws->objects_drawn());
    state.counters["clusters_tested"] = static_cast<double>(clusters.tested);
    state.counters["clusters_turned"] = static_cast<double>(clusters.turned_away);
    state.counters["clusters_outside"] = static_cast<double>(clusters.outside);
    state.counters["clusters_hidden"] = static_cast<double>(clusters.occluded);
    state.counters["clusters_between"] = static_cast<double>(clusters.between_samples);
    state.counters["triangles"] = static_cast<double>(stage().draws->triangles_drawn());
    state.counters["draws"] = static_cast<double>(stage().draws->commands().size());
}

double occluders_ms(const Camera& camera) {
    static OcclusionBuffer buffer;
    const double begin = thread_ms();
    buffer.begin(camera);
    benchmark::DoNotOptimize(stage().occluders->draw(camera, kRevealMargin_m, buffer));
    return thread_ms() - begin;
}

const std::vector<std::uint32_t>& find_objects(Culling& culling, const Camera& camera) {
    culling.move();
    return culling.visible(camera);
}

double objects_ms(const Camera& camera) {
    const double begin = thread_ms();
    benchmark::DoNotOptimize(find_objects(*stage().culling, camera).size());
    return thread_ms() - begin;
}

double objects_two_threads_ms(const Camera& camera) {
    const double begin = clock_ms();
    benchmark::DoNotOptimize(find_objects(*stage().culling_by_two, camera).size());
    return clock_ms() - begin;
}

void list_draws(const std::vector<std::uint32_t>& visible, const Culling& culling, const Camera& camera,
                TaskPool* threads) {
    Stage& s = stage();
    s.draws->build(visible, camera, s.gpu_scene->parts(),
                   {&s.gpu_scene->clusters(), culling.cluster_view(camera), threads});
}

double clusters_ms(const Camera& camera) {
    const std::vector<std::uint32_t>& visible = stage().culling->visible(camera);
    forget_caches();
    const double begin = thread_ms();
    list_draws(visible, *stage().culling, camera, nullptr);
    return thread_ms() - begin;
}

double clusters_two_threads_ms(const Camera& camera) {
    const std::vector<std::uint32_t>& visible = stage().culling->visible(camera);
    forget_caches();
    const double begin = clock_ms();
    list_draws(visible, *stage().culling, camera, stage().two_threads.get());
    return clock_ms() - begin;
}

double all_ms(const Camera& camera) {
    const double begin = thread_ms();
    Culling& culling = *stage().culling;
    list_draws(find_objects(culling, camera), culling, camera, nullptr);
    return thread_ms() - begin;
}

double all_two_threads_ms(const Camera& camera) {
    stage().two_threads->rouse();  // as a frame does before it places what moves
    const double begin = clock_ms();
    Culling& culling = *stage().culling_by_two;
    list_draws(find_objects(culling, camera), culling, camera, stage().two_threads.get());
    return clock_ms() - begin;
}

void add(const char* name, double (*ms_of_frame)(const Camera&)) {
    benchmark::RegisterBenchmark(name, [ms_of_frame](benchmark::State& state) { run(state, ms_of_frame); })
        ->Iterations(kFrames)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace lw::bench

int main(int argc, char** argv) {
    lw::bench::add("culling/occluders", lw::bench::occluders_ms);
    lw::bench::add("culling/objects", lw::bench::objects_ms);
    lw::bench::add("culling/objects/threads=2", lw::bench::objects_two_threads_ms);
    lw::bench::add("culling/clusters", lw::bench::clusters_ms);
    lw::bench::add("culling/clusters/threads=2", lw::bench::clusters_two_threads_ms);
    lw::bench::add("culling/all", lw::bench::all_ms);
    lw::bench::add("culling/all/threads=2", lw::bench::all_two_threads_ms);
    return lw::bench::run_benchmarks(argc, argv);
}
