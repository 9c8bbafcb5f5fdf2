/// `latewarp render`: the truth at a pose, and the frame that the client would publish there.

#include <memory>

#include "apps/report.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"
#include "client_renderer/hidden_layer.h"
#include "core/image_io.h"
#include "frame_link/frame_folder.h"

namespace lw {

namespace {

// A single frame tells nothing of the head's motion: a hidden layer is for heads this near, unless --reveal-margin says
// otherwise.
constexpr double kHeadMotion_m = 0.05;

/// What the client publishes for a display with `camera`, movers at the same time.
RenderedFrame client_frame(SceneRenderer& renderer, const Camera& camera, double scene_time_s,
                           const SourceSettings& source, double head_motion_m) {
    auto layer = std::make_shared<Layer>();
    layer->camera = source_camera(camera, source.density, source.guard_band_rad.value_or(0.0));
    layer->scene_time_s = scene_time_s;
    layer->pose_sampled = at_seconds(scene_time_s);
    renderer.draw_resolved(layer->camera, scene_time_s, source.samples_per_axis, layer->cpu());
    renderer.mover_placements(scene_time_s, layer->movers);
    if (source.layers == 1) return {1, {std::move(layer)}, {}};
    auto hidden = std::make_shared<Layer>();
    draw_hidden_layer(renderer, *layer, source.samples_per_axis, head_motion_m, *hidden);
    return {1, {std::move(layer), std::move(hidden)}, {}};
}

}  // namespace

Status run_render(const Options& options) {
    const Status writable = check_output_file(options.output);
    if (!writable) return writable;
    Result<SceneStage> stage = make_stage(options);
    if (!stage) return stage.error();
    Camera camera = options.camera();
    camera.world_from_eye = options.pose.value_or(start_pose_of(*stage->scene));

    ColourImage truth;
    stage->renderer->draw_supersampled(camera, options.scene_time_s, options.truth_samples, truth);
    if (!options.frame.empty()) {
        const double head_motion_m = options.reveal_margin_m.value_or(kHeadMotion_m);
        stage->renderer->set_reveal_margin(head_motion_m);
        const RenderedFrame frame =
            client_frame(*stage->renderer, camera, options.scene_time_s, options.source, head_motion_m);
        const Status saved = save_frame_folder(frame, options.frame);
        if (!saved) return saved;
    }
    return write_png(options.output, truth);
}

}  // namespace lw
