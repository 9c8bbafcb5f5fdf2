#include "frame_link/drawn_view.h"

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
    DrawnView view{std::string{name_of(eye)}, eye_camera(display, rig.eye(eye), {}), rig.eye(eye).head_from_eye, eye};
    return view;
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
        return std::vector{DrawnView{"main", *centre, centre->world_from_eye, {}}};
    }
    const DrawnView left = eye_view(display, rig, Eye::left);
    DrawnView right = eye_view(display, rig, Eye::right);
    if (const std::string_view why = why_not_rectified(right.camera, left.camera); !why.empty()) {
        return Error{fmt::format("stereo by scan lines needs eyes side by side, and {}", why), "--stereo scanline",
                     "choose --stereo one-render, or eyes that are not turned"};
    }
    right.name = "main";
    right.for_eye.reset();
    return std::vector{std::move(right)};
}

}  // namespace lw
