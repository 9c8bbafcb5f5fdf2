/// Time of every warp method and its preparation, beside a memcpy of the colour and depth they read; of two threads
/// over one; of processors without AVX-512; and of the fills. GL methods are there where a GL context is.
///
/// Frames take turns, as they do live: neither the copy nor the warp finds its source in the cache. Each time is the
/// median of its repeats, taken in turns with the copies of the same run; memcpy_ratio is the quotient of the medians.
/// CPU methods are first checked: a still head must show the source.

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "bench/run_benchmarks.h"
#include "bench/warp_server/half_covered_layer.h"
#include "core/check.h"
#include "gl/context.h"
#include "warp_server/fill.h"
#include "warp_server/methods/registry.h"

namespace lw::bench {
namespace {

constexpr glm::ivec2 kSize_px{1024, 1024};
constexpr int kMovers = 1000;
constexpr std::size_t kFrames = 4;

// Of several samples per pixel a frame holds the quarters too.
enum class SourceSamples { one, several };

// The same picture in different memory.
std::vector<Layer> make_layers(SourceSamples samples) {
    std::vector<Layer> all;
    for (std::size_t i = 0; i < kFrames; ++i) {
        Layer layer = half_covered_layer(kSize_px, kMovers);
        all.push_back(samples == SourceSamples::one ? std::move(layer) : with_quarters(std::move(layer)));
    }
    return all;
}

const std::vector<Layer>& layers() {
    static const std::vector<Layer> made = make_layers(SourceSamples::one);
    return made;
}

double milliseconds(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double quantile(std::vector<double> values, double part) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

// Copies colour and depth of one frame.
void copy_pixels(const CpuPixels& from, CpuPixels& to) {
    std::memcpy(to.colour.pixels().data(), from.colour.pixels().data(), from.colour.size_bytes());
    std::memcpy(to.depth.pixels().data(), from.depth.pixels().data(), from.depth.size_bytes());
}

// Runs `work(frame)` in turns with copies and reports both medians.
void measure(benchmark::State& state, const std::function<void(std::size_t)>& work) {
    std::vector<CpuPixels> copies(kFrames, CpuPixels{ColourImage{kSize_px}, DepthImage{kSize_px}, {}});
    std::vector<double> work_ms;
    std::vector<double> copy_ms;
    std::size_t turn = 0;
    for (std::size_t warm_up = 0; warm_up < kFrames; ++warm_up) work(warm_up);
    for (auto _ : state) {
        const std::size_t frame = turn++ % kFrames;
        copy_ms.push_back(milliseconds([&] { copy_pixels(layers()[(frame + 2) % kFrames].cpu(), copies[frame]); }));
        const double ms = milliseconds([&] { work(frame); });
        work_ms.push_back(ms);
        state.SetIterationTime(ms * 1e-3);
        benchmark::ClobberMemory();
    }
    state.counters["median_ms"] = quantile(work_ms, 0.5);
    state.counters["p99_ms"] = quantile(work_ms, 0.99);
    state.counters["memcpy_ms"] = quantile(copy_ms, 0.5);
    state.counters["memcpy_ratio"] = quantile(work_ms, 0.5) / quantile(copy_ms, 0.5);
}

// Made current on the benchmark's only thread at the first call; null where there is no GL.
gl::Context* gl_context() {
    static const std::unique_ptr<gl::Context> made = [] {
        auto context = gl::Context::create();
        if (!context) return std::unique_ptr<gl::Context>{};
        (*context)->make_current();
        return std::move(*context);
    }();
    return made.get();
}

std::unique_ptr<WarpMethod> checked_method(const std::string& specification) {
    Result<std::unique_ptr<WarpMethod>> method = make_warp_method(specification);
    LW_CHECK(method.ok(), method.ok() ? std::string{} : method.error().message());
    // On GL a footprint may round up to the next pixel; by how much is the business of the methods' tests.
    if (find_warp_method(specification)->needs_gl) return std::move(*method);
    DisplayFrame frame;
    const Layer& layer = layers().front();
    (*method)->warp(layer, {layer.camera, layer.movers}, frame);
    LW_CHECK(frame.colour == layer.cpu().colour, specification + " does not show the source to a still head");
    return std::move(*method);
}

// A head that only turned, about the vertical axis.
Camera turned_head(const Camera& source, double degrees) {
    Camera camera = source;
    camera.world_from_eye.orientation =
        glm::angleAxis(glm::radians(degrees), glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
    return camera;
}

void warp(benchmark::State& state, const std::string& specification, const Camera& camera,
          SourceSamples samples = SourceSamples::one) {
    const auto method = checked_method(specification);
    std::vector<Layer> prepared = make_layers(samples);
    for (Layer& layer : prepared) {
        if (auto ready = method->prepare(layer)) layer.prepared.emplace_back(specification, std::move(ready));
    }
    const std::vector<ObjectTransform> movers = moved_objects(prepared[0]);
    DisplayFrame frames[2];
    measure(state, [&](std::size_t i) { method->warp(prepared[i], {camera, movers}, frames[i % 2]); });
    state.counters["hole_fraction"] = hole_fraction(frames[0]);
}

// The work of a processor that knows AVX2 and nothing newer.
void with_avx2(const std::function<void()>& work) {
    hwy::SetSupportedTargetsForTest(HWY_AVX2);
    work();
    hwy::SetSupportedTargetsForTest(0);
}

void prepare(benchmark::State& state, const std::string& specification, SourceSamples samples = SourceSamples::one) {
    const auto method = checked_method(specification);
    const std::vector<Layer> sources = make_layers(samples);
    measure(state, [&](std::size_t i) { benchmark::DoNotOptimize(method->prepare(sources[i])); });
}

// One and two threads in turns: what disturbs the machine disturbs both.
void two_threads(benchmark::State& state, const std::string& name) {
    const std::unique_ptr<WarpMethod> methods[2] = {checked_method(name), checked_method(name + ":threads=2")};
    std::vector<Layer> prepared = make_layers(SourceSamples::one);
    for (Layer& layer : prepared) {
        for (const auto& method : methods) {
            if (auto ready = method->prepare(layer)) {
                layer.prepared.emplace_back(std::string{method->label()}, std::move(ready));
            }
        }
    }
    const std::vector<ObjectTransform> movers = moved_objects(prepared[0]);
    const WarpTarget target{moved_head(prepared[0].camera), movers};
    DisplayFrame frames[2];
    std::vector<double> took_ms[2];
    const auto warp_both = [&](std::size_t turn) {
        for (const std::size_t which : {0u, 1u}) {
            const Layer& layer = prepared[(turn + 2 * which) % kFrames];
            took_ms[which].push_back(milliseconds([&] { methods[which]->warp(layer, target, frames[which]); }));
        }
    };
    for (std::size_t warm_up = 0; warm_up < kFrames; ++warm_up) warp_both(warm_up);
    for (auto& times : took_ms) times.clear();
    std::size_t turn = 0;
    for (auto _ : state) {
        warp_both(turn++);
        state.SetIterationTime(took_ms[1].back() * 1e-3);
    }
    state.counters["one_thread_ms"] = quantile(took_ms[0], 0.5);
    state.counters["two_threads_ms"] = quantile(took_ms[1], 0.5);
    state.counters["speed_up"] = quantile(took_ms[0], 0.5) / quantile(took_ms[1], 0.5);
}

void copy(benchmark::State& state) {
    CpuPixels target{ColourImage{kSize_px}, DepthImage{kSize_px}, {}};
    measure(state, [&](std::size_t i) { copy_pixels(layers()[i].cpu(), target); });
}

void fill(benchmark::State& state, const std::string& name) {
    const auto method = checked_method("splat");
    const Camera camera = moved_head(layers()[0].camera);
    std::vector<DisplayFrame> frames(kFrames);
    for (DisplayFrame& frame : frames) method->warp(layers()[0], {camera, moved_objects(layers()[0])}, frame);
    Result<std::unique_ptr<Fill>> made = make_fill(name);
    LW_CHECK(made.ok(), name);
    // A filled frame has no holes left, so each repeat starts from the coverage of the warped one.
    const Image<Coverage> coverage = frames[0].coverage;
    measure(state, [&](std::size_t i) {
        std::memcpy(frames[i].coverage.pixels().data(), coverage.pixels().data(), coverage.size_bytes());
        (*made)->apply(frames[i], fill_guide(layers()[0].camera, camera));
    });
}

void register_all() {
    const auto add = [](const std::string& name, const std::function<void(benchmark::State&)>& run) {
        benchmark::RegisterBenchmark(name.c_str(), run)->UseManualTime()->Iterations(41)->Unit(benchmark::kMillisecond);
    };
    add("memcpy", copy);
    for (const MethodEntry& entry : warp_methods()) {
        if (entry.name == "reference" || (entry.needs_gl && gl_context() == nullptr)) continue;
        const std::string name{entry.name};
        add("warp/" + name, [name](benchmark::State& state) { warp(state, name, moved_head(layers()[0].camera)); });
        if (entry.settings.find("threads") == std::string_view::npos) continue;
        add("warp/" + name + ":threads=2",
            [name](benchmark::State& state) { warp(state, name + ":threads=2", moved_head(layers()[0].camera)); });
        add("two_threads_over_one/" + name, [name](benchmark::State& state) { two_threads(state, name); });
    }
    for (const std::string name : {"splat", "splat:threads=2", "surface", "surface:threads=2"}) {
        for (const int degrees : {0, 5, 10, 20, 30}) {
            add("turned/" + name + "/degrees=" + std::to_string(degrees), [name, degrees](benchmark::State& state) {
                warp(state, name, turned_head(layers()[0].camera, degrees));
            });
        }
    }
    for (const std::string name : {"splat", "surface", "surface:threads=2"}) {
        add("prepare/" + name, [name](benchmark::State& state) { prepare(state, name); });
    }
    add("samples/warp/surface", [](benchmark::State& state) {
        warp(state, "surface", moved_head(layers()[0].camera), SourceSamples::several);
    });
    add("samples/prepare/surface", [](benchmark::State& state) { prepare(state, "surface", SourceSamples::several); });
    const auto newer_than_avx2 = hwy::SupportedTargets() & (HWY_AVX2 - 1);
    if (newer_than_avx2 != 0 && (hwy::SupportedTargets() & HWY_AVX2) != 0) {
        for (const std::string name : {"splat", "surface"}) {
            add("avx2/" + name, [name](benchmark::State& state) {
                with_avx2([&] { warp(state, name, moved_head(layers()[0].camera)); });
            });
        }
        add("avx2/prepare/surface", [](benchmark::State& state) { with_avx2([&] { prepare(state, "surface"); }); });
    }
    for (const std::string name : {"nearest-background", "pyramid"}) {
        add("fill/" + name, [name](benchmark::State& state) { fill(state, name); });
    }
}

}  // namespace
}  // namespace lw::bench

int main(int argc, char** argv) {
    lw::bench::register_all();
    return lw::bench::run_benchmarks(argc, argv);
}
