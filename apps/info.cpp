/// `latewarp info`: counts, bounds and what was ignored, as JSON on standard output.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <fstream>

#include "apps/culling_map.h"
#include "apps/report.h"
#include "apps/subcommands.h"
#include "core/image_io.h"
#include "frame_link/frame_folder.h"
#include "frame_link/trace.h"
#include "scene/built_in.h"

namespace lw {

namespace {

void set_vector(Report& report, const std::string& path, const glm::dvec3& v) {
    const std::array<double, 3> numbers{v.x, v.y, v.z};
    report.set(path, std::span<const double>{numbers});
}

void set_pose(Report& report, const std::string& path, const Pose& pose) {
    set_vector(report, path + "/position_m", pose.position_m);
    const glm::dquat& q = pose.orientation;
    const std::array<double, 4> xyzw{q.x, q.y, q.z, q.w};
    report.set(path + "/orientation_xyzw", std::span<const double>{xyzw});
}

Status describe_scene_file(Report& report, const Options& options) {
    const Result<scene::Scene> scene = scene::load_scene(options.input.string(), options.parameters);
    if (!scene) return scene.error();
    std::uint64_t vertex_count = 0;
    for (const scene::Mesh& mesh : scene->meshes) vertex_count += mesh.vertices.size();
    report.set("kind", "scene");
    describe_scene(report, *scene);
    report.set("scene/meshes", static_cast<std::uint64_t>(scene->meshes.size()));
    report.set("scene/vertices", vertex_count);
    report.set("scene/materials", static_cast<std::uint64_t>(scene->materials.size()));
    report.set("scene/images", static_cast<std::uint64_t>(scene->images.size()));
    report.set("scene/nodes", static_cast<std::uint64_t>(scene->nodes.size()));
    report.set("scene/animation_channels", static_cast<std::uint64_t>(scene->channels.size()));
    report.set("scene/point_lights", static_cast<std::uint64_t>(scene->point_lights.size()));
    if (!scene->bounds_world.empty()) {
        set_vector(report, "scene/bounds_world/min_m", scene->bounds_world.min);
        set_vector(report, "scene/bounds_world/max_m", scene->bounds_world.max);
    }
    if (scene->start_pose) set_pose(report, "scene/start_pose", *scene->start_pose);
    report.set("warnings", scene->warnings);
    if (options.culling_map.empty()) return Done{};
    constexpr int kMapSide_px = 1024;
    Camera camera = options.camera();
    camera.world_from_eye = options.pose.value_or(scene->start_pose.value_or(Pose{}));
    return write_png(options.culling_map, culling_map(*scene, options.culling, camera, 0.0, kMapSide_px));
}

void describe_layer(Report& report, const std::string& path, const Layer& layer) {
    const CpuPixels& pixels = layer.cpu();
    const auto depths = pixels.depth.pixels();
    const auto ids = pixels.object_id.pixels();
    const auto background = std::count(depths.begin(), depths.end(), 0.0f);
    const auto moving = std::count_if(ids.begin(), ids.end(), [](ObjectId id) { return id != 0; });
    double nearest_depth = 0.0;
    for (const float depth : depths) nearest_depth = std::max(nearest_depth, static_cast<double>(depth));
    const FovTangents& fov = layer.camera.fov;
    const std::array<double, 4> tangents{fov.left, fov.right, fov.down, fov.up};
    report.set(path + "/size_px", layer.camera.size_px);
    report.set(path + "/fov_tangents", std::span<const double>{tangents});
    report.set(path + "/near_m", layer.camera.near_m);
    report.set(path + "/time_s", layer.scene_time_s);
    set_pose(report, path + "/world_from_eye", layer.camera.world_from_eye);
    report.set(path + "/objects", static_cast<std::uint64_t>(layer.movers.size()));
    const double count = std::max(1.0, static_cast<double>(depths.size()));
    report.set(path + "/background_fraction", static_cast<double>(background) / count);
    report.set(path + "/mover_fraction", static_cast<double>(moving) / count);
    report.set(path + "/nearest_m", distance_m(nearest_depth, layer.camera.near_m));
}

Status describe_frame_folder(Report& report, const std::filesystem::path& folder) {
    const Result<LoadedFrame> loaded = load_frame_folder(folder);
    if (!loaded) return loaded.error();
    report.set("kind", "frame");
    for (const auto& layer : loaded->frame->layers) describe_layer(report, "layers/" + layer->name, *layer);
    report.set("warnings", loaded->warnings);
    return Done{};
}

Status describe_trace(Report& report, const std::string& name_or_path) {
    const Result<Trace> trace = load_trace(name_or_path);
    if (!trace) return trace.error();
    const std::vector<TimedPose>& poses = trace->poses();
    scene::Bounds bounds;
    double path_m = 0.0;
    double turn_rad = 0.0;
    double longest_gap_s = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        bounds.include(poses[i].world_from_head.position_m);
        if (i == 0) continue;
        const Pose& before = poses[i - 1].world_from_head;
        path_m += glm::length(poses[i].world_from_head.position_m - before.position_m);
        turn_rad += angle_between_rad(before.orientation, poses[i].world_from_head.orientation);
        longest_gap_s = std::max(longest_gap_s, poses[i].time_s - poses[i - 1].time_s);
    }
    const double duration_s = trace->duration_s();
    report.set("kind", "trace");
    report.set("trace/name", trace->name());
    report.set("trace/samples", static_cast<std::uint64_t>(poses.size()));
    report.set("trace/begin_s", poses.front().time_s);
    report.set("trace/duration_s", duration_s);
    report.set("trace/longest_gap_s", longest_gap_s);
    report.set("trace/path_m", path_m);
    report.set("trace/mean_speed_m_per_s", duration_s > 0 ? path_m / duration_s : 0.0);
    report.set("trace/mean_turn_deg_per_s", duration_s > 0 ? turn_rad / kRadPerDeg / duration_s : 0.0);
    set_vector(report, "trace/bounds/min_m", bounds.min);
    set_vector(report, "trace/bounds/max_m", bounds.max);
    report.set("warnings", trace->warnings());
    return Done{};
}

/// By extension, else by how the file begins: binary glTF has a magic word, a JSON glTF an opening brace.
bool is_scene_file(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (extension == ".gltf" || extension == ".glb") return true;
    std::array<char, 4> begin{};
    std::ifstream{path, std::ios::binary}.read(begin.data(), begin.size());
    return std::string_view{begin.data(), begin.size()} == "glTF" || begin[0] == '{';
}

bool is_built_in_scene(const std::string& name) {
    const auto scenes = scene::built_in_scenes();
    return std::any_of(scenes.begin(), scenes.end(), [&](const auto& entry) { return entry.name == name; });
}

Status describe(Report& report, const Options& options) {
    const std::string name = options.input.string();
    const bool exists = std::filesystem::exists(options.input);
    if (!exists && is_built_in_scene(name)) return describe_scene_file(report, options);
    if (std::filesystem::is_directory(options.input)) return describe_frame_folder(report, options.input);
    if (exists && is_scene_file(options.input)) return describe_scene_file(report, options);
    return describe_trace(report, name);
}

}  // namespace

Status run_info(const Options& options) {
    Report report{Subcommand::info};
    const Status described = describe(report, options);
    if (!described) return described;
    std::fputs(report.text().c_str(), stdout);
    return Done{};
}

}  // namespace lw
