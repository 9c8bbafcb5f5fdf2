/// What is skipped must not be missed: pictures with and without skipping are equal bit for bit.

#include <gtest/gtest.h>

#include <filesystem>

#include "client_renderer/scene_renderer.h"
#include "frame_link/built_in_traces.h"
#include "frame_link/trace.h"
#include "scene/built_in.h"
#include "tests/client_renderer/hand_made_scenes.h"
#include "tests/support/gl_test.h"
#include "tests/support/shared_data.h"

namespace lw {
namespace {

scene::Scene built_in(std::string_view name, const scene::Parameters& parameters) {
    auto scene = scene::make_built_in(name, parameters);
    EXPECT_TRUE(scene.ok()) << scene.error().message();
    return std::move(scene).value();
}

std::unique_ptr<SceneRenderer> renderer_of(const scene::Scene& scene, const CullingSettings& culling) {
    auto renderer = SceneRenderer::create(scene, {culling});
    EXPECT_TRUE(renderer.ok()) << renderer.error().message();
    return std::move(renderer).value();
}

struct Skipped {
    std::uint64_t objects = 0;
    std::uint64_t occluded = 0;
    std::uint64_t drawn = 0;
};

/// Compares pictures along a trace that starts where the scene's viewer does. `steps` poses, `step_s` apart.
Skipped expect_equal_pictures(const scene::Scene& scene, const std::string& trace_name, int steps, double step_s,
                              double reveal_margin_m) {
    auto skipping = renderer_of(scene, {.reveal_margin_m = reveal_margin_m});
    auto drawing_all = renderer_of(scene, {.skip = false});
    auto trace = load_trace(trace_name);
    EXPECT_TRUE(trace.ok()) << trace.error().message();
    const Trace placed = trace->placed_at(*scene.start_pose, 0.0);
    Camera camera = test::plain_camera({192, 160});
    Skipped skipped;
    CpuPixels some;
    CpuPixels all;
    for (int i = 0; i < steps; ++i) {
        const double time_s = i * step_s;
        camera.world_from_eye = placed.at(time_s);
        skipping->draw(camera, time_s, some);
        drawing_all->draw(camera, time_s, all);
        EXPECT_EQ(some.depth, all.depth) << trace_name << " at " << time_s;
        EXPECT_EQ(some.colour, all.colour) << trace_name << " at " << time_s;
        EXPECT_EQ(some.object_id, all.object_id) << trace_name << " at " << time_s;
        const DrawCounters& counters = skipping->counters();
        EXPECT_EQ(counters.objects_tested, counters.objects_drawn + counters.objects_outside +
                                               counters.objects_occluded + counters.objects_behind_walls +
                                               counters.objects_between_samples);
        EXPECT_EQ(drawing_all->counters().objects_drawn, counters.objects_tested);
        skipped.objects += counters.objects_tested;
        skipped.occluded += counters.objects_occluded;
        skipped.drawn += counters.objects_drawn;
    }
    return skipped;
}

TEST(GlSkip, TheCityLooksTheSame) {
    LW_NEED_GL();
    const scene::Scene city = built_in("city", {{"buildings", 60.0}});
    const Skipped exact = expect_equal_pictures(city, "walk", 6, 1.7, 0.0);
    EXPECT_GT(exact.occluded, exact.objects / 5) << "houses hide much of a street";
    const Skipped with_margin = expect_equal_pictures(city, "look-around", 4, 1.1, 0.3);
    EXPECT_GT(with_margin.occluded, 0U);
}

TEST(GlSkip, RoomsLookTheSame) {
    LW_NEED_GL();
    const scene::Scene rooms = built_in("rooms", {{"rooms", 60.0}});
    const Skipped exact = expect_equal_pictures(rooms, "walk", 6, 1.3, 0.0);
    EXPECT_LT(exact.drawn, exact.objects / 5) << "though the walk leads through a wall, where all is seen";
    const Skipped with_margin = expect_equal_pictures(rooms, "look-around", 6, 0.9, 0.3);
    EXPECT_LT(with_margin.drawn, with_margin.objects / 5);
}

TEST(DataGlSkip, SharedScenesLookTheSameAlongRecordings) {
    LW_NEED_SHARED_DATA();
    LW_NEED_GL();
    const std::filesystem::path data = test::shared_data_dir();
    const std::vector<std::string> traces{
        (data / "head_traces/eyenavgs_rutgers/user113_truck.csv").string(),
        (data / "head_traces/questset/sample_movement_data.csv").string(),
    };
    for (const char* name :
         {"garage/garage.gltf", "office_diorama/office_diorama.glb", "TeapotsGalore/TeapotsGalore.gltf",
          "samplebuilding/subpass_scene_opaque.gltf", "home-theater/home-theater.gltf"}) {
        const std::filesystem::path path = data / "gltf" / name;
        if (!std::filesystem::exists(path)) continue;
        auto scene = scene::load_scene(path.string(), {});
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        for (const std::string& trace : traces) {
            for (const double margin_m : {0.0, 0.2}) (void)expect_equal_pictures(*scene, trace, 3, 2.7, margin_m);
        }
    }
}

}  // namespace
}  // namespace lw
