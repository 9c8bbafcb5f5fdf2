#pragma once
/// What a client draws per frame: one view for a single eye, and for two eyes what the way of making stereo asks for.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/camera.h"
#include "core/result.h"
#include "core/stereo_rig.h"

namespace lw {

/// Where the second eye's picture comes from (--stereo).
enum class StereoMode : std::uint8_t {
    two_renders,  ///< each eye is drawn
    one_render,   ///< one view between the eyes, warped to each of them
    scanline,     ///< the right eye is drawn, its pixels are shifted along their rows to the left one
};

[[nodiscard]] std::vector<std::string_view> stereo_mode_names();  ///< "two-renders", "one-render", "scanline"
[[nodiscard]] std::string_view name_of(StereoMode mode);
[[nodiscard]] std::optional<StereoMode> find_stereo_mode(std::string_view name);

/// One view of a client's frame.
struct DrawnView {
    std::string name = "main";
    Camera camera;                ///< size, field of view and near plane; its pose is not looked at
    Pose head_from_view;          ///< where it is drawn from
    std::optional<Eye> for_eye;   ///< nothing: for whoever looks
    double eye_distance_m = 0.0;  ///< from it to the farthest eye that is shown from it, besides what the head moves
};

/// The view of a display without stereo.
[[nodiscard]] inline std::vector<DrawnView> single_view(const Camera& display) {
    return {{"main", display, {}, {}, 0.0}};
}

/// The views of a display with two eyes, each of the size of `display`. Pure, any thread.
/// @return an error when the mode cannot serve the rig: no single picture holds both eyes' (one-render), or the eyes do
/// not look side by side (scanline)
[[nodiscard]] Result<std::vector<DrawnView>> stereo_views(const Camera& display, const StereoRig& rig, StereoMode mode);

}  // namespace lw
