/// What two eyes cost: one render warped to both, against two renders, in the built-in city at 1024x1024 per eye.
///
/// Everything is measured in turns in one run, so that whatever else the machine does falls on all alike; each time is
/// the median, `wall_` by the clock and `cpu_` of all threads together, which others on the machine disturb less.
/// Frames and head poses alternate: no warp finds its source in the cache or its picture already made.
///   eyes_over_one         both eyes' warps over one eye's, of the same frame, all on one thread
///   threads_over_threads  both eyes on two threads over one eye on two threads, by the clock
///   threads_over_one      the same over one eye on one thread
///   display_ratio         the client at 10 Hz under a display at 90: (render and prepare / 9 + both warps) over two
///                         renders for every display frame
///   app_ratio             the same rate for both: render, its prepare and both warps over two renders, their prepares
///                         and two warps
///   app_ratio_unprepared  the same over two renders and two warps, without what the warps need of their sources
///   two_threads_display_ratio  display_ratio by the clock, with a thread for half of both eyes each: as it runs live.
///                         The GL draws on two threads too
/// The fill is counted with the warp. `centre/...` is about where the one render is drawn from: midway with a margin,
/// or so far back that both frusta fit: holes before fill, SSIM to each eye's own render, mean of both eyes, head
/// still, and pixels over those of one eye.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "bench/run_benchmarks.h"
#include "client_renderer/hidden_layer.h"
#include "client_renderer/scene_renderer.h"
#include "core/check.h"
#include "core/metrics.h"
#include "gl/context.h"
#include "scene/built_in.h"
#include "warp_server/stereo_warper.h"

namespace lw::bench {
namespace {

constexpr int kRepeats = 31;
constexpr int kWarmUp = 3;
constexpr double kDisplayOverApp = 9.0;
constexpr std::size_t kFrames = 2;
// The head's motion between the drawing of a frame and its display, as for a reveal margin of 2 cm.
constexpr double kHeadMotion_m = 0.02;

struct Cost {
    double wall_ms = 0.0;
    double cpu_ms = 0.0;  ///< of all threads
};

Cost cost_of(const std::function<void()>& work) {
    const auto cpu_ms = [] {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
    };
    const double cpu_begin_ms = cpu_ms();
    const auto begin = std::chrono::steady_clock::now();
    work();
    const double wall_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return {wall_ms, cpu_ms() - cpu_begin_ms};
}

double median(const std::vector<Cost>& costs, double Cost::*time) {
    std::vector<double> values;
    for (const Cost& cost : costs) values.push_back(cost.*time);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Camera display() {
    Camera camera;
    camera.size_px = {1024, 1024};
    return camera;
}

StereoRig rig() { return mirrored_rig(0.063, display().fov); }

template <class T>
T required(Result<T> result) {
    LW_CHECK(result.ok(), result.ok() ? std::string{} : result.error().message());
    return std::move(*result);
}

using Layers = std::vector<std::shared_ptr<Layer>>;

RenderedFrame frame_of(const Layers& layers) { return {1, {layers.begin(), layers.end()}, {}}; }

/// The city on a GL context, drawn as a client does.
class City {
public:
    City() : context_{required(gl::Context::create())}, scene_{required(scene::make_built_in("city", {}))} {
        context_->make_current();
        renderer_ = required(SceneRenderer::create(scene_));
    }

    /// What the client publishes for a head pose.
    Layers draw(StereoMode mode, const Pose& head, int layers) {
        Layers drawn;
        for (const DrawnView& view : required(stereo_views(display(), rig(), mode))) {
            const std::shared_ptr<Layer> layer = draw_view(view, head);
            drawn.push_back(layer);
            if (layers < 2) continue;
            auto hidden = std::make_shared<Layer>();
            hidden->for_eye = view.for_eye;
            draw_hidden_layer(*renderer_, *layer, 1, view.eye_distance_m + kHeadMotion_m, *hidden);
            drawn.push_back(std::move(hidden));
        }
        return drawn;
    }
    std::shared_ptr<Layer> draw_view(const DrawnView& view, const Pose& head) {
        auto layer = std::make_shared<Layer>();
        layer->for_eye = view.for_eye;
        layer->camera = view.camera;
        layer->camera.world_from_eye = compose(head, view.head_from_view);
        layer->pixels = CpuPixels{};
        renderer_->draw(layer->camera, 0.0, layer->cpu());
        renderer_->mover_placements(0.0, layer->movers);
        return layer;
    }
    [[nodiscard]] Pose start() const { return scene_.start_pose.value_or(Pose{}); }
    void placements(double time_s, std::vector<ObjectTransform>& movers) {
        renderer_->mover_placements(time_s, movers);
    }

private:
    std::unique_ptr<gl::Context> context_;
    scene::Scene scene_;
    std::unique_ptr<SceneRenderer> renderer_;
};

struct Setting {
    std::string method;
    int layers = 1;
};

struct Costs {
    std::vector<Cost> two_plain_renders;
    std::vector<Cost> two_renders;
    std::vector<Cost> render;
    std::vector<Cost> prepare;
    std::vector<Cost> prepare_two;
    std::vector<Cost> one_eye;
    std::vector<Cost> both;
    std::vector<Cost> one_eye_two_threads;
    std::vector<Cost> both_two_threads;
    std::vector<Cost> both_of_two_renders;
};

std::unique_ptr<StereoWarper> warper_of(const std::string& method, bool parallel) {
    return required(StereoWarper::create(method, "nearest-background", StereoMode::one_render, display(),
                                         {.rig = rig(), .parallel = parallel}));
}

Costs costs_of(City& city, const Setting& setting) {
    const auto one_by_one = warper_of(setting.method, false);
    const auto at_once = warper_of(setting.method, true);
    FrameWarper one_eye = required(FrameWarper::create(setting.method, "nearest-background"));
    FrameWarper one_eye_threads = required(FrameWarper::create(setting.method + ":threads=2", "nearest-background"));
    std::array<Layers, kFrames> one;
    std::array<Layers, kFrames> two;
    Costs costs;
    std::vector<ObjectTransform> movers;
    city.placements(0.1, movers);
    for (int repeat = -kWarmUp; repeat < kRepeats; ++repeat) {
        const std::size_t turn = static_cast<std::size_t>(repeat + kWarmUp) % kFrames;
        const double side = turn == 0 ? 1.0 : -1.0;
        const Pose drawn_from = compose(city.start(), {{0.1 * side, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}});
        // 2 cm and 1.2 degrees later.
        WarpTarget head{display(), movers};
        head.camera.world_from_eye =
            compose(drawn_from,
                    {{0.014, 0.005, -0.012 * side}, glm::angleAxis(0.02, glm::normalize(glm::dvec3{0.3, side, 0.1}))});
        WarpTarget left = head;
        left.camera = eye_camera(display(), rig().eye(Eye::left), head.camera.world_from_eye);
        // What is drawn for every refresh needs nothing behind it.
        const Cost plain = cost_of([&] { (void)city.draw(StereoMode::two_renders, drawn_from, 1); });
        const Cost two_renders =
            cost_of([&] { two[turn] = city.draw(StereoMode::two_renders, drawn_from, setting.layers); });
        const Cost render = cost_of([&] { one[turn] = city.draw(StereoMode::one_render, drawn_from, setting.layers); });
        const auto prepare = [](const PictureMaker& warper, const Layers& layers) {
            for (const auto& layer : layers) warper.prepare(*layer);
        };
        const Cost preparing = cost_of([&] { prepare(*one_by_one, one[turn]); });
        prepare(one_eye_threads, one[turn]);
        const Cost preparing_two = cost_of([&] { prepare(*one_by_one, two[turn]); });
        const RenderedFrame frame = frame_of(one[turn]);
        const RenderedFrame frame_of_two = frame_of(two[turn]);
        const Cost eye = cost_of([&] { one_eye.warp(frame, left); });
        const Cost both = cost_of([&] { one_by_one->warp_eyes(frame, head); });
        const Cost eye_threads = cost_of([&] { one_eye_threads.warp(frame, left); });
        const Cost both_threads = cost_of([&] { at_once->warp_eyes(frame, head); });
        const Cost of_two = cost_of([&] { one_by_one->warp_eyes(frame_of_two, head); });
        if (repeat < 0) continue;
        costs.two_plain_renders.push_back(plain);
        costs.two_renders.push_back(two_renders);
        costs.render.push_back(render);
        costs.prepare.push_back(preparing);
        costs.prepare_two.push_back(preparing_two);
        costs.one_eye.push_back(eye);
        costs.both.push_back(both);
        costs.one_eye_two_threads.push_back(eye_threads);
        costs.both_two_threads.push_back(both_threads);
        costs.both_of_two_renders.push_back(of_two);
    }
    return costs;
}

City& city() {
    static City made;
    return made;
}

void report_times(benchmark::State& state, const Costs& costs, const std::string& kind, double Cost::*time) {
    const auto of = [time](const std::vector<Cost>& stage) { return median(stage, time); };
    const auto set = [&](const char* name, double value) { state.counters[kind + name] = value; };
    const double client = of(costs.render) + of(costs.prepare);
    set("two_renders_ms", of(costs.two_plain_renders));
    set("render_ms", of(costs.render));
    set("prepare_ms", of(costs.prepare));
    set("one_eye_ms", of(costs.one_eye));
    set("both_ms", of(costs.both));
    set("eyes_over_one", of(costs.both) / of(costs.one_eye));
    set("display_ratio", (client / kDisplayOverApp + of(costs.both)) / of(costs.two_plain_renders));
    const double two = of(costs.two_renders) + of(costs.both_of_two_renders);
    set("app_ratio", (client + of(costs.both)) / (two + of(costs.prepare_two)));
    set("app_ratio_unprepared", (client + of(costs.both)) / two);
}

void report(benchmark::State& state, const Setting& setting) {
    const Costs costs = costs_of(city(), setting);
    const auto wall_ms = [](const std::vector<Cost>& stage) { return median(stage, &Cost::wall_ms); };
    for (auto _ : state) state.SetIterationTime(wall_ms(costs.both) * 1e-3);
    report_times(state, costs, "wall_", &Cost::wall_ms);
    report_times(state, costs, "cpu_", &Cost::cpu_ms);
    const double client_ms = wall_ms(costs.render) + wall_ms(costs.prepare);
    state.counters["two_threads_display_ratio"] =
        (client_ms / kDisplayOverApp + wall_ms(costs.both_two_threads)) / wall_ms(costs.two_plain_renders);
    state.counters["threads_over_one"] = wall_ms(costs.both_two_threads) / wall_ms(costs.one_eye);
    state.counters["threads_over_threads"] = wall_ms(costs.both_two_threads) / wall_ms(costs.one_eye_two_threads);
}

void report_centre(benchmark::State& state, double nearest_m, double back_m) {
    const Camera centre = required(centre_view(display(), rig(), nearest_m, back_m));
    const DrawnView view{"main", centre, centre.world_from_eye, {}, 0.0};
    const auto warper = warper_of("surface", false);
    double holes = 0.0;
    double similarity = 0.0;
    for (auto _ : state) {
        RenderedFrame frame;
        frame.layers.push_back(city().draw_view(view, city().start()));
        WarpTarget head{display(), frame.layers.front()->movers};
        head.camera.world_from_eye = city().start();
        warper->warp_eyes(frame, head);
        const Layers own = city().draw(StereoMode::two_renders, city().start(), 1);
        for (const Eye eye : kEyes) {
            const ColourImage& drawn = own[static_cast<std::size_t>(eye)]->cpu().colour;
            holes += 0.5 * warper->eye(eye).hole_fraction();
            similarity += 0.5 * ssim(drawn, warper->eye(eye).display_frame().colour);
        }
    }
    state.counters["holes"] = holes;
    state.counters["ssim"] = similarity;
    state.counters["pixels_ratio"] = static_cast<double>(centre.size_px.x) * centre.size_px.y /
                                     (static_cast<double>(display().size_px.x) * display().size_px.y);
}

void register_all() {
    const auto centre = [](const char* name, double nearest_m, double back_m) {
        benchmark::RegisterBenchmark(name, [=](benchmark::State& state) { report_centre(state, nearest_m, back_m); })
            ->Iterations(1)
            ->Unit(benchmark::kMillisecond);
    };
    constexpr double kFar_m = 1e6;
    centre("centre/midway_without_margin", kFar_m, 0.0);
    centre("centre/midway", kNearestCovered_m, 0.0);
    centre("centre/back", kFar_m, distance_back_m(rig()));
    for (const char* method : {"splat", "surface"}) {
        for (const int layers : {1, 2}) {
            const Setting setting{method, layers};
            benchmark::RegisterBenchmark(fmt::format("stereo/{}/layers:{}", method, layers).c_str(),
                                         [setting](benchmark::State& state) { report(state, setting); })
                ->UseManualTime()
                ->Iterations(1)
                ->Unit(benchmark::kMillisecond);
        }
    }
}

}  // namespace
}  // namespace lw::bench

int main(int argc, char** argv) {
    lw::bench::register_all();
    return lw::bench::run_benchmarks(argc, argv);
}
