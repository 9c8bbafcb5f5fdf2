#include "frame_link/drawn_view.h"

#include <algorithm>
#include <array>
#include <utility>

namespace lw {
namespace {

constexpr std::array<std::pair<std::string_view, StereoMode>, 3> kModes{{
    {"two-renders", StereoMode::two_renders},
    {"one-render", StereoMode::one_render},
    {"scanline", StereoMode::scanline},
}};

DrawnView eye_view(const Camera& display, const StereoRig& rig, Eye eye) {
    DrawnView view{std::string{name_of(eye)}, eye_camera(display, rig.eye(eye), {}), rig.eye(eye).head_from_eye, eye,
                   0.0};
    return view;
}

double farthest_eye_m(const StereoRig& rig, const Pose& head_from_view) {
    double farthest_m = 0.0;
    for (const EyeView& eye : rig.eyes) {
        farthest_m = std::max(farthest_m, glm::distance(eye.head_from_eye.position_m, head_from_view.position_m));
    }
    return farthest_m;
}

}  // namespace

std::vector<std::string_view> stereo_mode_names() {
    std::vector<std::string_view> names;
    for (const auto& [name, mode] : kModes) names.push_back(name);
    return names;
}

std::string_view name_of(StereoMode mode) {
    for (const auto& [name, known] : kModes) {
        if (known == mode) return name;
    }
    return "unknown";
}

std::optional<StereoMode> find_stereo_mode(std::string_view name) {
    for (const auto& [known, mode] : kModes) {
        if (known == name) return mode;
    }
    return std::nullopt;
}

Result<std::vector<DrawnView>> stereo_views(const Camera& display, const StereoRig& rig, StereoMode mode) {
    if (mode == StereoMode::two_renders) {
        return std::vector{eye_view(display, rig, Eye::left), eye_view(display, rig, Eye::right)};
    }
    if (mode == StereoMode::one_render) {
        const Result<Camera> centre = centre_view(display, rig);
        if (!centre) return centre.error();
        const Pose& head_from_centre = centre->world_from_eye;
        return std::vector{DrawnView{"main", *centre, head_from_centre, {}, farthest_eye_m(rig, head_from_centre)}};
    }
    const DrawnView left = eye_view(display, rig, Eye::left);
    DrawnView right = eye_view(display, rig, Eye::right);
    if (const std::string_view why = why_not_rectified(right.camera, left.camera); !why.empty()) {
        return Error{fmt::format("stereo by scan lines needs eyes side by side, and {}", why), "--stereo scanline",
                     "choose --stereo one-render, or eyes that are not turned"};
    }
    right.name = "main";
    right.for_eye.reset();
    right.eye_distance_m = farthest_eye_m(rig, right.head_from_view);
    return std::vector{std::move(right)};
}

}  // namespace lw
