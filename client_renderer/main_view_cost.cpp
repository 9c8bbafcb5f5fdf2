#include "client_renderer/main_view_cost.h"

#include "client_renderer/layer_statistics.h"
#include "client_renderer/shell_budget.h"
#include "core/camera_picture.h"

namespace lw {

void MainViewCost::learn(SceneRenderer& renderer, const Camera& camera, double scene_time_s, int samples_per_axis) {
    Layer layer;
    layer.camera = camera;
    // The first draw of a size makes buffers.
    for (int i = 0; i < (clock_ != nullptr ? 2 : 1); ++i) {
        const TimePoint begin = clock_ != nullptr ? clock_->now() : TimePoint{};
        renderer.draw_resolved(camera, scene_time_s, samples_per_axis, layer.cpu());
        if (clock_ != nullptr) ms_per_pixel_ = to_ms(clock_->now() - begin) / pixel_count(camera);
    }
    triangles_ = static_cast<double>(renderer.counters().triangles_drawn);
    covered_share_ = statistics_of(layer).surface_px / pixel_count(camera);
}

double MainViewCost::expected_ms(const Camera& camera, int samples_per_axis) const {
    return clock_ != nullptr ? ms_per_pixel_ * pixel_count(camera) : modelled_ms(camera, samples_per_axis, 1.0);
}

double MainViewCost::modelled_ms(const Camera& camera, int samples_per_axis, double share) const {
    const double samples = pixel_count(camera) * samples_per_axis * samples_per_axis;
    return modelled_cost_ms(share * triangles_, samples, covered_share_ * samples);
}

}  // namespace lw
