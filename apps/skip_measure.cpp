#include "apps/skip_measure.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <random>

#include "apps/alone_in_view.h"
#include "apps/real_clock.h"
#include "apps/visible_objects.h"
#include "client_renderer/box_tree.h"
#include "client_renderer/culling.h"
#include "client_renderer/scene_renderer.h"
#include "core/check.h"

namespace lw {

namespace {

constexpr int kSidePx = 1024;
constexpr double kQuarterTurn = 1.5707963267948966;

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median_of(std::vector<double> values) {
    std::ranges::sort(values);
    return percentile_of_sorted(values, 50.0);
}

Camera square_camera(int side_px) {
    Camera camera;
    camera.size_px = {side_px, side_px};
    camera.fov = FovTangents::symmetric(kQuarterTurn, 1.0);
    return camera;
}

/// Boxes of 0.2 to 2 m scattered over a flat square with the density of a town: one per 9 square metres.
std::vector<scene::Bounds> scattered_boxes(std::size_t count) {
    std::mt19937_64 random{12};
    std::uniform_real_distribution<double> unit{0.0, 1.0};
    const double side_m = 3.0 * std::sqrt(static_cast<double>(count));
    std::vector<scene::Bounds> boxes;
    boxes.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 centre{side_m * (unit(random) - 0.5), 3.0 * unit(random), side_m * (unit(random) - 0.5)};
        const glm::dvec3 half{0.1 + 0.9 * unit(random)};
        boxes.push_back({centre - half, centre + half});
    }
    return boxes;
}

/// A walk near a corner of the square, looking out of it and turning: at most a twentieth is in view.
Camera walking_camera(std::size_t objects, int step) {
    Camera camera = square_camera(kSidePx);
    const double side_m = 3.0 * std::sqrt(static_cast<double>(objects));
    camera.world_from_eye.position_m = {-0.44 * side_m + 0.03 * step, 1.65, -0.42 * side_m};
    camera.world_from_eye.orientation = glm::angleAxis(0.5 + 0.01 * step, glm::dvec3{0.0, 1.0, 0.0});
    return camera;
}

double read_ns_per_object(const BoxList& list) {
    std::vector<double> times_ms;
    double sum = 0.0;
    for (int repeat = 0; repeat < 15; ++repeat) {
        const double begin = now_ms();
        std::uint64_t bits = 0;
        for (int row = 0; row < 6; ++row) {
            const float* values = list.row(row);
            std::array<std::uint64_t, 8> partial{};
            for (std::size_t i = 0; i + 16 <= list.size(); i += 16) {
                for (std::size_t k = 0; k < 8; ++k) {
                    std::uint64_t two = 0;
                    std::copy_n(reinterpret_cast<const char*>(values + i + 2 * k), 8, reinterpret_cast<char*>(&two));
                    partial[k] ^= two;
                }
            }
            for (const std::uint64_t p : partial) bits ^= p;
        }
        times_ms.push_back(now_ms() - begin);
        sum += static_cast<double>(bits & 1U);
    }
    // The sum is used, so that the reading is not left out.
    return (median_of(times_ms) + 1e-12 * sum) * 1e6 / static_cast<double>(list.size());
}

}  // namespace

FrustumTiming time_frustum(std::size_t objects) {
    FrustumTiming timing;
    timing.objects = objects;
    const std::vector<scene::Bounds> boxes = scattered_boxes(objects);
    BoxList list;
    list.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) list.set(i, boxes[i]);
    BoxTree tree{boxes};

    std::vector<double> linear_ms;
    std::vector<double> tree_ms;
    std::vector<double> several_ms;
    std::vector<double> one_by_one_ms;
    std::vector<std::uint32_t> seen;
    std::vector<SeenItem> seen_by_several;
    double seen_sum = 0.0;
    constexpr int kSteps = 60;
    constexpr int kWarmUp = 5;
    // Small lists take less than the clock can tell: repeated until about 100 microseconds.
    const int repeats = std::max(1, static_cast<int>(65536 / objects));
    for (int step = -kWarmUp; step < kSteps; ++step) {
        const Camera camera = walking_camera(objects, step);
        const Frustum frustum = frustum_of(camera);
        WalkQuery query;
        query.frustum = rounded(frustum);
        std::vector<Frustum> six;
        for (int face = 0; face < 6; ++face) {
            Camera turned = camera;
            turned.world_from_eye.orientation =
                camera.world_from_eye.orientation *
                (face < 4 ? glm::angleAxis(kQuarterTurn * face, glm::dvec3{0, 1, 0})
                          : glm::angleAxis(kQuarterTurn * (2 * face - 9), glm::dvec3{1, 0, 0}));
            six.push_back(frustum_of(turned));
        }
        const auto time_ms = [&](auto work) {
            const double begin = now_ms();
            for (int i = 0; i < repeats; ++i) work();
            return (now_ms() - begin) / repeats;
        };
        const double linear = time_ms([&] {
            seen.clear();
            list.append_seen(frustum, seen);
        });
        const std::size_t seen_by_list = seen.size();
        const double hierarchical = time_ms([&] {
            seen.clear();
            tree.append_seen(query, seen);
        });
        LW_CHECK(seen.size() == seen_by_list, "the list and the hierarchy see different things");
        const double several = time_ms([&] {
            seen_by_several.clear();
            tree.append_seen(six, seen_by_several);
        });
        const double one_by_one = time_ms([&] {
            for (const Frustum& face : six) {
                WalkQuery face_query;
                face_query.frustum = rounded(face);
                seen.clear();
                tree.append_seen(face_query, seen);
            }
        });
        if (step < 0) continue;
        linear_ms.push_back(linear);
        tree_ms.push_back(hierarchical);
        several_ms.push_back(several);
        one_by_one_ms.push_back(one_by_one);
        seen_sum += static_cast<double>(seen_by_list) / static_cast<double>(objects);
    }
    const double ns = 1e6 / static_cast<double>(objects);
    timing.seen_fraction = seen_sum / kSteps;
    timing.linear_ns = median_of(linear_ms) * ns;
    timing.hierarchical_ns = median_of(tree_ms) * ns;
    timing.several_ns = median_of(several_ms) * ns;
    timing.one_by_one_ns = median_of(one_by_one_ms) * ns;
    timing.read_ns = read_ns_per_object(list);
    return timing;
}

Result<FrameTiming> time_frames(const scene::Scene& scene, const CullingSettings& settings, std::string label,
                                int frames, DrawOrder order) {
    RealClock clock;  // not a thread's processor time, which would leave out waiting for the other one
    auto renderer = SceneRenderer::create(scene, {.culling = settings, .clock = &clock, .order = order});
    if (!renderer) return renderer.error();
    FrameTiming timing;
    timing.label = std::move(label);
    timing.objects = scene.instances.size();
    timing.triangles = scene.triangle_count();
    Camera camera = square_camera(kSidePx);
    const Pose start = scene.start_pose.value_or(Pose{});
    CpuPixels pixels;
    std::vector<double> frame_ms;
    std::vector<double> culling_ms;
    for (int i = -std::min(frames, 3); i < frames; ++i) {
        camera.world_from_eye = start;
        camera.world_from_eye.position_m += start.orientation * glm::dvec3{0.0, 0.0, -0.05 * std::max(i, 0)};
        const double begin = now_ms();
        (*renderer)->draw(camera, 0.1 * std::max(i, 0), pixels);
        if (i < 0) continue;
        frame_ms.push_back(now_ms() - begin);
        culling_ms.push_back(to_ms((*renderer)->counters().culling));
    }
    timing.objects_drawn = (*renderer)->counters().objects_drawn;
    timing.triangles_drawn = (*renderer)->counters().triangles_drawn;
    timing.draw_calls = (*renderer)->counters().draw_calls;
    timing.frame_ms = median_of(frame_ms);
    timing.culling_ms = *distribution_of(culling_ms);
    return timing;
}

namespace {

/// The frame's own eye, and one in each direction of a cube's faces and corners.
std::vector<glm::dvec3> eyes_around(const glm::dvec3& eye, double margin_m) {
    std::vector<glm::dvec3> eyes{eye};
    if (!(margin_m > 0.0)) return eyes;
    for (int x = -1; x <= 1; ++x) {
        for (int y = -1; y <= 1; ++y) {
            for (int z = -1; z <= 1; ++z) {
                const int axes = std::abs(x) + std::abs(y) + std::abs(z);
                if (axes == 1 || axes == 3) eyes.push_back(eye + margin_m * glm::normalize(glm::dvec3{x, y, z}));
            }
        }
    }
    return eyes;
}

double expected_margin_m(const Trace& placed, double time_s) {
    double farthest_m = 0.0;
    const glm::dvec3 here = placed.at(time_s).position_m;
    for (int i = 1; i <= 4; ++i) {
        farthest_m = std::max(farthest_m, glm::distance(here, placed.at(time_s + 0.05 * i).position_m));
    }
    return 1.5 * farthest_m + 0.005;
}

}  // namespace

Result<RevealCheck> check_reveal(const scene::Scene& scene, const Trace& trace, int count, double step_s,
                                 std::optional<double> margin_m) {
    auto oracle = VisibleObjects::create(scene);
    if (!oracle) return oracle.error();
    scene::SceneState state{scene};
    state.set_time(0.0);
    PlacedInstances placed{scene, state};
    Culling culling{placed, {}};
    const Trace walk = trace.placed_at(scene.start_pose.value_or(Pose{}), 0.0);
    RevealCheck check;
    check.scene = scene.name;
    check.trace = trace.name();
    double margin_sum_m = 0.0;
    for (int i = 0; i < count; ++i) {
        const double time_s = i * step_s;
        Camera camera = square_camera(kSidePx);
        camera.world_from_eye = walk.at(time_s);
        const double margin = margin_m.value_or(expected_margin_m(walk, time_s));
        margin_sum_m += margin;
        state.set_time(time_s);
        placed.move(state);
        culling.move();
        culling.set_reveal_margin(margin);
        std::vector<bool> drawn(placed.size(), false);
        for (const std::uint32_t object : culling.visible(camera)) drawn[object] = true;

        std::vector<bool> seen(scene.instances.size(), false);
        Camera eye_camera = camera;
        for (const glm::dvec3& eye : eyes_around(camera.world_from_eye.position_m, margin)) {
            eye_camera.world_from_eye.position_m = eye;
            (*oracle)->add_seen_within(camera, eye_camera, time_s, seen);
        }
        const Frustum frustum = frustum_of(camera);
        for (std::size_t object = 0; object < placed.size(); ++object) {
            if (!may_see(frustum, placed[object].bounds_world)) continue;
            // What has no pixel in the frame even alone is not hidden, and no view warped from the frame can show it.
            if (!has_pixel_alone(scene, placed[object], camera)) continue;
            ++check.in_view;
            const bool is_seen = seen[static_cast<std::size_t>(placed[object].instance - scene.instances.data())];
            if (!is_seen) ++check.hidden;
            if (drawn[object]) continue;
            if (is_seen) {
                ++check.wrongly_skipped;
            } else {
                ++check.skipped_hidden;
            }
        }
        ++check.views;
    }
    check.margin_m = margin_sum_m / std::max(count, 1);
    return check;
}

}  // namespace lw
