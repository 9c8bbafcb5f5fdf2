#pragma once
/// What all measurements of the suite `billboards` share: the scene, the flight through it, and the ways to draw it.

#include <vector>

#include "apps/billboard_trial.h"
#include "apps/real_clock.h"
#include "core/camera.h"
#include "core/result.h"
#include "frame_link/trace.h"
#include "scene/scene.h"

namespace lw {

/// Belongs to one GL context and its thread.
class BillboardStage {
public:
    /// `scene` is finished and outlives the stage.
    BillboardStage(const scene::Scene& scene, bool quiet);

    [[nodiscard]] const scene::Scene& scene() const { return scene_; }
    [[nodiscard]] double duration_s() const { return flight_.duration_s(); }
    [[nodiscard]] bool quiet() const { return quiet_; }

    /// On the flight, 90 degrees across.
    [[nodiscard]] Camera camera_at(double time_s, glm::ivec2 size_px) const;
    /// Cameras from `from_s` on until before `to_s`.
    [[nodiscard]] std::vector<Camera> cameras(double from_s, double to_s, double step_s, glm::ivec2 size_px) const;
    /// `count` cameras on a walk to the side, from `step_m` to `step_m`, about the place on the flight at `time_s`.
    [[nodiscard]] std::vector<Camera> walk_beside(double time_s, int count, double step_m, glm::ivec2 size_px) const;

    [[nodiscard]] Result<BillboardTrial> trial(std::string label, const BillboardSettings& settings) const;

    /// The meshes' pictures, `samples_per_axis` squared samples per pixel, resolved as a source of a warp is.
    [[nodiscard]] Result<std::vector<ColourImage>> meshes(const std::vector<Camera>& cameras,
                                                          int samples_per_axis) const;
    /// The same as an ideal display shows them: 4 x 4 samples, averaged.
    [[nodiscard]] Result<std::vector<ColourImage>> truth(const std::vector<Camera>& cameras) const;

private:
    const scene::Scene& scene_;
    bool quiet_;
    Trace flight_;
    RealClock wall_clock_;
    ProcessorClock processor_clock_;
};

/// Billboards drawn anew by the three angles, at most `updates` of them per frame.
[[nodiscard]] BillboardSettings by_angles(BillboardMode mode, int updates);
/// By the pixels they are off.
[[nodiscard]] BillboardSettings by_error(BillboardMode mode, double cap_px);
[[nodiscard]] const char* name_of(BillboardMode mode);

/// Of any order; 0 for none.
[[nodiscard]] double median_of(std::vector<double> values);

}  // namespace lw
