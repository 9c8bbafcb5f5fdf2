#include "apps/warp_sweep_stage.h"

#include "client_renderer/source_camera.h"

namespace lw {

namespace {

constexpr double kTrackerHz = 1000.0;
constexpr double kFirstPhoton_s = 0.5;

/// Puts a scene on the stage, on the context that is there or on a new one.
Status load(const std::string& name, SceneStage& stage) {
    Options options;
    options.scene = name;
    options.quiet = true;
    if (!stage.context) {
        Result<SceneStage> made = make_stage(options);
        if (!made) return made.error();
        stage = *std::move(made);
        return Done{};
    }
    stage.renderer.reset();  // its memory before the next scene's
    Result<std::unique_ptr<const scene::Scene>> scene = load_scene_of(options);
    if (!scene) return scene.error();
    stage.scene = *std::move(scene);
    Result<std::unique_ptr<SceneRenderer>> renderer = SceneRenderer::create(*stage.scene);
    if (!renderer) return renderer.error();
    stage.renderer = *std::move(renderer);
    return Done{};
}

}  // namespace

SweepStage::SweepStage(SceneStage stage, std::string scene, TraceFeed feed)
    : stage_{std::move(stage)}, scene_{std::move(scene)}, feed_{std::make_unique<TraceFeed>(std::move(feed))} {}

Result<SweepStage> SweepStage::create(const SweepPair& pair, std::optional<SweepStage> previous) {
    Result<Trace> trace = load_trace(pair.trace);
    if (!trace) return trace.error();
    SceneStage stage;
    if (previous) stage = std::move(previous->stage_);
    if (!previous || previous->scene_ != pair.scene) {
        Status status = load(pair.scene, stage);
        if (!status) return status.error();
    }
    TraceFeed feed{trace->placed_at(start_pose_of(*stage.scene), pair.trace_start_s), TimePoint{}, kTrackerHz};
    return SweepStage{std::move(stage), pair.scene, std::move(feed)};
}

Camera SweepStage::target_camera(glm::ivec2 size_px, double photon_s) const {
    Options options;
    options.size_px = size_px;
    Camera camera = options.camera();
    camera.world_from_eye = feed_->pose_at(at_seconds(photon_s));
    return camera;
}

std::vector<ObjectTransform> SweepStage::target_movers(double photon_s) {
    std::vector<ObjectTransform> movers;
    renderer().mover_placements(photon_s, movers);
    return movers;
}

std::shared_ptr<Layer> SweepStage::source(const BenchConditions& conditions, double photon_s) {
    const double sampled_s = photon_s - conditions.frame_age_ms * 1e-3;
    const TimePoint sampled = at_seconds(sampled_s);
    SourceCameras cameras{target_camera(conditions.size_px, photon_s),
                          {conditions.source_samples, conditions.source_density, std::nullopt}};
    auto layer = std::make_shared<Layer>();
    layer->camera = cameras.next(*feed_, sampled, from_ms(conditions.frame_age_ms));
    layer->camera.world_from_eye = feed_->pose_at(sampled);
    layer->pose_sampled = sampled;
    layer->scene_time_s = sampled_s;
    renderer().draw_resolved(layer->camera, sampled_s, conditions.source_samples, layer->cpu());
    renderer().mover_placements(sampled_s, layer->movers);
    return layer;
}

double photon_s_of(const SweepPlan& plan, std::size_t index) {
    return kFirstPhoton_s + plan.frame_spacing_s * static_cast<double>(index);
}

}  // namespace lw
