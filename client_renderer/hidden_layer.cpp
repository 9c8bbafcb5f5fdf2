#include "client_renderer/hidden_layer.h"

#include "client_renderer/hidden_limits.h"

namespace lw {

void draw_hidden_layer(SceneRenderer& renderer, const Layer& first, int samples_per_axis, double head_motion_m,
                       Layer& hidden, ScenePart part) {
    const DepthImage limits = hidden_limits(first.camera, first.cpu().depth, head_motion_m);
    part.behind = &limits;
    hidden.name = "hidden";
    hidden.camera = first.camera;
    hidden.pose_sampled = first.pose_sampled;
    hidden.scene_time_s = first.scene_time_s;
    hidden.movers = first.movers;
    if (!std::holds_alternative<CpuPixels>(hidden.pixels)) hidden.pixels = CpuPixels{};
    hidden.empty_pixels = renderer.draw_part(hidden.camera, hidden.scene_time_s, samples_per_axis, part, hidden.cpu());
}

}  // namespace lw
