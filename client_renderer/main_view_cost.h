#pragma once
/// What one view of everything costs: the measure of an automatic budget, and of items that were never drawn.

#include "client_renderer/scene_renderer.h"
#include "core/camera.h"
#include "core/clock.h"

namespace lw {

/// Belongs to the renderer's thread.
class MainViewCost {
public:
    /// @param clock  measures; null: costs are modelled. Outlives this
    explicit MainViewCost(const Clock* clock) : clock_{clock} {}

    /// Draws everything that `camera` sees.
    void learn(SceneRenderer& renderer, const Camera& camera, double scene_time_s, int samples_per_axis);

    /// Of one view of everything; before learn() none and all.
    [[nodiscard]] double triangles() const { return triangles_; }
    [[nodiscard]] double covered_share() const { return covered_share_; }  ///< of its samples, that show a surface

    /// What it takes with `camera`: measured per pixel, or modelled.
    [[nodiscard]] double expected_ms(const Camera& camera, int samples_per_axis) const;
    /// What a picture with `share` of its triangles is modelled to take.
    [[nodiscard]] double modelled_ms(const Camera& camera, int samples_per_axis, double share) const;

private:
    const Clock* clock_;
    double triangles_ = 0.0;
    double covered_share_ = 1.0;
    double ms_per_pixel_ = 0.0;  ///< where costs are measured
};

}  // namespace lw
