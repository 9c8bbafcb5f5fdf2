/// Does the warp's cost depend on the scene's triangles? One picture is tessellated into ten thousand to ten million
/// triangles, drawn by the client, and its frame prepared, warped and filled as the server does.
///
/// The warp gets pixels, so it cannot see the triangles; what it could see is a picture that differs (checked: it does
/// not), and memory that the scene has displaced. Frames of all scenes are drawn first and then warped in turns, with
/// copies between them, so that whatever else the machine does falls on all of them alike. `over_fewest` is the median
/// over that of the scene with the fewest triangles; `draw_ms` is the client's cost, which does grow.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "bench/run_benchmarks.h"
#include "bench/whole_path/tessellated_room.h"
#include "client_renderer/scene_renderer.h"
#include "core/check.h"
#include "gl/context.h"
#include "warp_server/frame_warper.h"

namespace lw::bench {
namespace {

constexpr glm::ivec2 kSize_px{1024, 1024};
constexpr std::uint64_t kTriangles[] = {10'000, 100'000, 1'000'000, 10'000'000};
constexpr int kRepeats = 41;
constexpr const char* kMethods[] = {"splat", "surface"};

double milliseconds(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

struct Drawn {
    std::uint64_t triangles = 0;
    double draw_ms = 0.0;
    std::shared_ptr<Layer> layer;
};

Drawn draw(std::uint64_t triangles) {
    const scene::Scene scene = tessellated_room(triangles);
    auto renderer = SceneRenderer::create(scene);
    LW_CHECK(renderer.ok(), renderer.ok() ? std::string{} : renderer.error().message());
    Drawn drawn;
    drawn.triangles = scene.triangle_count();
    drawn.layer = std::make_shared<Layer>();
    drawn.layer->camera = room_camera(kSize_px);
    drawn.layer->pixels = CpuPixels{};
    const auto once = [&] { (*renderer)->draw(drawn.layer->camera, 0.0, drawn.layer->cpu()); };
    once();  // LLVM compiles at the first draw of a size
    drawn.draw_ms = median({milliseconds(once), milliseconds(once), milliseconds(once)});
    return drawn;
}

/// Rounding may move an edge across a sample's centre, no more.
void check_same_picture(const Drawn& a, const Drawn& b) {
    std::size_t different = 0;
    const auto& left = a.layer->cpu().colour.pixels();
    const auto& right = b.layer->cpu().colour.pixels();
    for (std::size_t i = 0; i < left.size(); ++i) {
        const int step = std::max(
            {std::abs(left[i].r - right[i].r), std::abs(left[i].g - right[i].g), std::abs(left[i].b - right[i].b)});
        if (step > 8) ++different;
    }
    LW_CHECK(different * 200 < left.size(), fmt::format("{} pixels differ", different));
}

const std::vector<Drawn>& all_drawn() {
    static const std::vector<Drawn> made = [] {
        auto context = gl::Context::create();
        LW_CHECK(context.ok(), context.ok() ? std::string{} : context.error().message());
        (*context)->make_current();
        std::vector<Drawn> all;
        for (const std::uint64_t triangles : kTriangles) all.push_back(draw(triangles));
        for (const Drawn& drawn : all) check_same_picture(all.front(), drawn);
        (*context)->release_current();
        return all;
    }();
    return made;
}

struct Times {
    std::vector<double> warp_ms;
    std::vector<double> prepare_ms;
    std::vector<double> copy_ms;
};

void copy_pixels(const CpuPixels& from, CpuPixels& to) {
    to.colour.resize(from.colour.size_px());
    to.depth.resize(from.depth.size_px());
    std::memcpy(to.colour.pixels().data(), from.colour.pixels().data(), from.colour.size_bytes());
    std::memcpy(to.depth.pixels().data(), from.depth.pixels().data(), from.depth.size_bytes());
}

/// All scenes in turns, so that they share whatever disturbs.
std::vector<Times> times_of(const std::string& method) {
    auto warper = FrameWarper::create(method, "nearest-background");
    LW_CHECK(warper.ok(), method);
    Camera target = room_camera(kSize_px);
    const glm::dquat turn = glm::angleAxis(0.02, glm::normalize(glm::dvec3{0.3, 1.0, 0.1}));
    target.world_from_eye = compose(target.world_from_eye, Pose{{0.014, 0.005, -0.012}, turn});
    CpuPixels copy;
    std::vector<Times> times(all_drawn().size());
    for (int repeat = -3; repeat < kRepeats; ++repeat) {
        for (std::size_t i = 0; i < times.size(); ++i) {
            const Drawn& drawn = all_drawn()[i];
            // Of another scene's frame: its own would be in the cache when it is warped.
            const Drawn& other = all_drawn()[(i + 2) % times.size()];
            const double copy_ms = milliseconds([&] { copy_pixels(other.layer->cpu(), copy); });
            const double prepare_ms = milliseconds([&] { warper->prepare(*drawn.layer); });
            const double warp_ms = milliseconds([&] { (void)warper->warp({1, {drawn.layer}, {}}, {target, {}}); });
            if (repeat < 0) continue;
            times[i].copy_ms.push_back(copy_ms);
            times[i].prepare_ms.push_back(prepare_ms);
            times[i].warp_ms.push_back(warp_ms);
        }
    }
    return times;
}

void report(benchmark::State& state, const std::string& method, std::size_t index) {
    static std::map<std::string, std::vector<Times>> measured;
    if (measured.count(method) == 0) measured[method] = times_of(method);
    const std::vector<Times>& times = measured[method];
    const double ms = median(times[index].warp_ms);
    for (auto _ : state) state.SetIterationTime(ms * 1e-3);
    state.counters["triangles"] = static_cast<double>(all_drawn()[index].triangles);
    state.counters["draw_ms"] = all_drawn()[index].draw_ms;
    state.counters["prepare_ms"] = median(times[index].prepare_ms);
    state.counters["median_ms"] = ms;
    state.counters["memcpy_ratio"] = ms / median(times[index].copy_ms);
    state.counters["over_fewest"] = ms / median(times.front().warp_ms);
}

void register_all() {
    for (const std::string method : kMethods) {
        for (std::size_t i = 0; i < std::size(kTriangles); ++i) {
            const std::string name = fmt::format("triangles/{}/{}", method, kTriangles[i]);
            benchmark::RegisterBenchmark(name.c_str(),
                                         [method, i](benchmark::State& state) { report(state, method, i); })
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
