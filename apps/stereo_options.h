#pragma once
/// What the command line says of the viewer's eyes.

#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/stereo_rig.h"
#include "frame_link/drawn_view.h"
#include "frame_link/trace.h"
#include "warp_server/eye_layout.h"

namespace lw {

struct Options;

struct StereoOptions {
    bool on = false;                             ///< --eyes stereo
    StereoMode mode = StereoMode::one_render;    ///< --stereo
    double ipd_m = 0.063;                        ///< --ipd, millimetres on the command line, [0, 200]
    std::optional<FovTangents> left_fov;         ///< --eye-fov; the right eye's is its mirror image
    glm::dquat left_turn{1.0, 0.0, 0.0, 0.0};    ///< --eye-turn; the right eye's is its mirror image
    EyeLayout layout = EyeLayout::side_by_side;  ///< --stereo-output
};

/// The rig that the options describe. Fields of view: --eye-fov, else --fov, else the recorded headset's where `trace`
/// tells them, else --fov's default. Pure.
[[nodiscard]] StereoRig stereo_rig_of(const Options& options, const Trace* trace);

/// What the client draws: one view without --eyes stereo. An error as of stereo_views(). Pure.
[[nodiscard]] Result<std::vector<DrawnView>> drawn_views_of(const Options& options, const Trace* trace);

}  // namespace lw
