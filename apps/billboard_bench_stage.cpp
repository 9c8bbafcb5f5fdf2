#include "apps/billboard_bench_stage.h"

#include <algorithm>

#include "apps/options.h"
#include "apps/progress.h"
#include "core/statistics.h"

namespace lw {

namespace {

constexpr int kTruthSamples = 4;

}  // namespace

BillboardStage::BillboardStage(const scene::Scene& scene, bool quiet)
    : scene_{scene}, quiet_{quiet}, flight_{load_trace("dive")->placed_at(scene.start_pose.value_or(Pose{}), 0.0)} {}

Camera BillboardStage::camera_at(double time_s, glm::ivec2 size_px) const {
    Camera camera;
    camera.size_px = size_px;
    camera.fov = FovTangents::symmetric(90.0 * kRadPerDeg, static_cast<double>(size_px.x) / size_px.y);
    camera.world_from_eye = flight_.at(time_s);
    return camera;
}

std::vector<Camera> BillboardStage::cameras(double from_s, double to_s, double step_s, glm::ivec2 size_px) const {
    std::vector<Camera> cameras;
    for (int k = 0; from_s + k * step_s < to_s; ++k) cameras.push_back(camera_at(from_s + k * step_s, size_px));
    return cameras;
}

std::vector<Camera> BillboardStage::walk_beside(double time_s, int count, double step_m, glm::ivec2 size_px) const {
    std::vector<Camera> cameras(static_cast<std::size_t>(count), camera_at(time_s, size_px));
    for (int k = 0; k < count; ++k) {
        cameras[static_cast<std::size_t>(k)].world_from_eye.position_m.x += step_m * (k - 0.5 * (count - 1));
    }
    return cameras;
}

Result<BillboardTrial> BillboardStage::trial(std::string label, const BillboardSettings& settings) const {
    return BillboardTrial::create(std::move(label), scene_, settings, {&wall_clock_, &processor_clock_});
}

Result<std::vector<ColourImage>> BillboardStage::meshes(const std::vector<Camera>& cameras,
                                                        int samples_per_axis) const {
    auto drawn = trial("meshes", {});
    if (!drawn.ok()) return drawn.error();
    std::vector<ColourImage> pictures;
    Progress progress{"billboards: meshes", cameras.size(), quiet_};
    for (const Camera& camera : cameras) {
        pictures.push_back(drawn->draw(camera, 0.0, samples_per_axis));
        progress.show(pictures.size());
    }
    return pictures;
}

Result<std::vector<ColourImage>> BillboardStage::truth(const std::vector<Camera>& cameras) const {
    auto renderer = SceneRenderer::create(scene_);
    if (!renderer.ok()) return renderer.error();
    std::vector<ColourImage> pictures(cameras.size());
    Progress progress{"billboards: truth", cameras.size(), quiet_};
    for (std::size_t k = 0; k < cameras.size(); ++k) {
        (*renderer)->draw_supersampled(cameras[k], 0.0, kTruthSamples, pictures[k]);
        progress.show(k + 1);
    }
    return pictures;
}

BillboardSettings by_angles(BillboardMode mode, int updates) {
    BillboardSettings settings;
    settings.mode = mode;
    settings.criterion = UpdateCriterion::angles;
    settings.max_updates = settings.max_creations = updates;
    return settings;
}

BillboardSettings by_error(BillboardMode mode, double cap_px) {
    BillboardSettings settings;
    settings.mode = mode;
    settings.error_cap_px = cap_px;
    settings.max_creations = settings.max_updates;
    return settings;
}

const char* name_of(BillboardMode mode) {
    return mode == BillboardMode::flat ? "flat" : mode == BillboardMode::warped ? "warped" : "off";
}

double median_of(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::ranges::sort(values);
    return percentile_of_sorted(values, 50.0);
}

}  // namespace lw
