/// The warp's time against the number of triangles: one picture, drawn from 10 thousand to 10 million of them.
///
/// A street of plane walls whose squares are cut into ever smaller ones looks the same however finely they are cut. The
/// client's time is reported beside the warp's. The cases take turns, so that the machine's moods meet all of them.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <string>
#include <vector>

#include "client_renderer/scene_renderer.h"
#include "core/check.h"
#include "core/metrics.h"
#include "gl/context.h"
#include "scene/scene.h"
#include "warp_server/methods/registry.h"

namespace lw::bench {
namespace {

constexpr glm::ivec2 kSize_px{1024, 1024};
constexpr int kWalls = 5;
// Triangles are 2 * kWalls * n * n.
constexpr int kSquaresPerSide[] = {32, 316, 1000};  // 10 thousand, 1 million, 10 million triangles
constexpr int kRepeats = 61;

// A square of side 2 in the plane z = 0, cut into n x n squares, with colours that vary smoothly over it.
scene::Mesh cut_square(int n) {
    scene::Mesh mesh;
    for (int y = 0; y <= n; ++y) {
        for (int x = 0; x <= n; ++x) {
            scene::Vertex vertex;
            const glm::vec2 place = 2.0F * glm::vec2{x, y} / static_cast<float>(n) - 1.0F;
            vertex.position_object = {place, 0.0F};
            vertex.normal_object = {0.0F, 0.0F, 1.0F};
            vertex.uv = 0.5F * place + 0.5F;
            mesh.vertices.push_back(vertex);
        }
    }
    const auto index = [n](int x, int y) { return static_cast<std::uint32_t>(y * (n + 1) + x); };
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            for (const std::uint32_t i : {index(x, y), index(x + 1, y), index(x + 1, y + 1), index(x, y),
                                          index(x + 1, y + 1), index(x, y + 1)}) {
                mesh.indices.push_back(i);
            }
        }
    }
    mesh.primitives = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
    return mesh;
}

scene::TextureImage bricks() {
    scene::TextureImage image{"bricks", ColourImage{{256, 256}}};
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const bool joint = y % 16 < 2 || (x + (y / 16 % 2) * 16) % 32 < 2;
            const auto level = static_cast<std::uint8_t>(joint ? 200 : 90 + (x * 7 + y * 13) % 40);
            image.pixels.at(x, y) = {level, static_cast<std::uint8_t>(level - 20), 80, 255};
        }
    }
    return image;
}

scene::Scene walls(int squares_per_side) {
    scene::Scene scene;
    scene.images.push_back(bricks());
    scene::Material material;
    material.base_colour_texture.image = 0;
    material.double_sided = true;
    scene.materials.push_back(material);
    scene.meshes.push_back(cut_square(squares_per_side));
    for (int i = 0; i < kWalls; ++i) {  // ever farther, each to another side: edges and disocclusions between them
        scene::Node node;
        const double distance_m = 2.0 + 1.5 * i;
        const glm::dvec3 place{i % 2 == 0 ? -1.0 : 1.2, 0.3 * (i % 3) - 0.3, -distance_m};
        node.matrix = glm::scale(glm::rotate(glm::translate(glm::dmat4{1.0}, place), 0.3 * (i - 2), {0.0, 1.0, 0.0}),
                                 glm::dvec3{0.8 + 0.35 * i});
        scene.nodes.push_back(node);
        scene.instances.push_back({0, i, glm::dmat4{1.0}, 0});
    }
    scene.start_pose = Pose{};
    scene.finish();
    return scene;
}

double milliseconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

struct Drawn {
    std::uint64_t triangles = 0;
    double draw_ms = 0.0;
    Layer layer;
};

Drawn draw(int squares_per_side) {
    const scene::Scene scene = walls(squares_per_side);
    auto renderer = SceneRenderer::create(scene);
    LW_CHECK(renderer.ok(), renderer.ok() ? std::string{} : renderer.error().message());
    Drawn drawn;
    drawn.triangles = scene.triangle_count();
    drawn.layer.camera.size_px = kSize_px;
    drawn.layer.pixels = CpuPixels{};
    (*renderer)->draw(drawn.layer.camera, 0.0, drawn.layer.cpu());  // the first draw uploads
    const auto begin = std::chrono::steady_clock::now();
    (*renderer)->draw(drawn.layer.camera, 0.0, drawn.layer.cpu());
    drawn.draw_ms = milliseconds_since(begin);
    return drawn;
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

// Finer squares move vertices by rounding only: the pictures agree but for single pixels at edges.
void check_that_the_picture_is_the_same(const std::vector<Drawn>& all) {
    for (const Drawn& drawn : all) {
        const auto psnr = psnr_db(all.front().layer.cpu().colour, drawn.layer.cpu().colour);
        LW_CHECK(!psnr || *psnr > 35.0, std::to_string(drawn.triangles) + " triangles show another picture");
    }
}

void warp(benchmark::State& state, const std::string& name) {
    auto context = gl::Context::create();
    LW_CHECK(context.ok(), context.ok() ? std::string{} : context.error().message());
    (*context)->make_current();
    std::vector<Drawn> all;
    for (const int squares : kSquaresPerSide) all.push_back(draw(squares));
    check_that_the_picture_is_the_same(all);
    Result<std::unique_ptr<WarpMethod>> method = make_warp_method(name);
    LW_CHECK(method.ok(), name);
    for (Drawn& drawn : all) {
        if (auto ready = (*method)->prepare(drawn.layer)) drawn.layer.prepared.emplace_back(name, std::move(ready));
    }
    Camera target = all.front().layer.camera;
    target.world_from_eye = Pose{{0.05, 0.01, -0.03}, glm::angleAxis(0.02, glm::dvec3{0.0, 1.0, 0.0})};
    std::vector<std::vector<double>> times_ms(all.size());
    DisplayFrame frame;
    for (const Drawn& drawn : all) (*method)->warp(drawn.layer, {target, {}}, frame);
    for (auto _ : state) {
        double sum_ms = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            const auto begin = std::chrono::steady_clock::now();
            (*method)->warp(all[i].layer, {target, {}}, frame);
            times_ms[i].push_back(milliseconds_since(begin));
            sum_ms += times_ms[i].back();
        }
        state.SetIterationTime(1e-3 * sum_ms / static_cast<double>(all.size()));
    }
    std::vector<double> medians_ms;
    for (std::size_t i = 0; i < all.size(); ++i) {
        medians_ms.push_back(median(times_ms[i]));
        const std::string triangles = std::to_string(all[i].triangles);
        state.counters["warp_ms_at_" + triangles] = medians_ms.back();
        state.counters["draw_ms_at_" + triangles] = all[i].draw_ms;
    }
    const auto [least, most] = std::minmax_element(medians_ms.begin(), medians_ms.end());
    state.counters["most_over_least"] = *most / *least;
}

}  // namespace
}  // namespace lw::bench

int main(int argc, char** argv) {
    for (const std::string name : {"surface", "splat"}) {
        benchmark::RegisterBenchmark(("warp_by_triangles/" + name).c_str(),
                                     [name](benchmark::State& state) { lw::bench::warp(state, name); })
            ->UseManualTime()
            ->Iterations(lw::bench::kRepeats)
            ->Unit(benchmark::kMillisecond);
    }
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}
