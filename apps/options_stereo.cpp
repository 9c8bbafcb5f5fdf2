#include <array>
#include <cmath>

#include "apps/option_declarer.h"
#include "apps/option_groups.h"

namespace lw {
namespace {

using namespace option_values;

/// "a,b,c,d" as degrees.
template <std::size_t Count>
std::array<double, Count> parsed_degrees(const std::string& option, const std::string& text, const Range& range) {
    std::array<double, Count> degrees{};
    std::size_t begin = 0;
    for (std::size_t i = 0; i < Count; ++i) {
        const std::size_t comma = text.find(',', begin);
        const bool is_last = i + 1 == Count;
        if (begin > text.size() || is_last != (comma == std::string::npos)) {
            usage_error(fmt::format("not {} numbers", Count), option + " " + text, "separate them by commas, degrees");
        }
        degrees[i] = number_in(option, text.substr(begin, comma - begin), range);
        begin = comma + 1;
    }
    return degrees;
}

FovTangents parsed_eye_fov(const std::string& text) {
    const auto degrees = parsed_degrees<4>("--eye-fov", text, {-85, 85});
    const auto tangent = [&](std::size_t i) { return std::tan(degrees[i] * kRadPerDeg); };
    const FovTangents fov{tangent(0), tangent(1), tangent(2), tangent(3)};
    if (!(fov.left < fov.right && fov.down < fov.up)) {
        usage_error("not a field of view", "--eye-fov " + text, "give LEFT,RIGHT,DOWN,UP, as -54,40,-54,42");
    }
    return fov;
}

glm::dquat parsed_eye_turn(const std::string& text) {
    const auto degrees = parsed_degrees<3>("--eye-turn", text, {-90, 90});
    const auto about = [&](std::size_t i, const glm::dvec3& axis) {
        return glm::angleAxis(degrees[i] * kRadPerDeg, axis);
    };
    return about(0, {0.0, 1.0, 0.0}) * about(1, {1.0, 0.0, 0.0}) * about(2, {0.0, 0.0, 1.0});
}

void declare_eyes(Declarer& declare, StereoOptions& stereo) {
    declare.value("--eyes", "mono|stereo", "one picture, or one for each eye (mono)",
                  [&stereo](const std::string& text) {
                      check_name("number of eyes", "--eyes", text, {"mono", "stereo"});
                      stereo.on = text == "stereo";
                  });
    declare.value("--ipd", "MM", "distance between the eyes (63)", [&stereo](const std::string& text) {
        stereo.ipd_m = number_in("--ipd", text, {0, 200}) / 1e3;
    });
    declare.value("--eye-fov", "LEFT,RIGHT,DOWN,UP",
                  "what the left eye sees, signed degrees; the right eye mirrors it (the recorded headset's, or --fov)",
                  [&stereo](const std::string& text) { stereo.left_fov = parsed_eye_fov(text); });
    declare.value(
        "--eye-turn", "YAW,PITCH,ROLL",
        "how the left eye is turned in the head, degrees, left and up positive; the right eye mirrors it (0,0,0)",
        [&stereo](const std::string& text) { stereo.left_turn = parsed_eye_turn(text); });
}

}  // namespace

void declare_stereo(Declarer& declare) {
    StereoOptions& stereo = declare.options().stereo;
    declare_eyes(declare, stereo);
    declare.value("--stereo", joined_by_bar(stereo_mode_names()), "how the second eye's picture is made (one-render)",
                  [&stereo](const std::string& text) {
                      check_name("way to make stereo", "--stereo", text, stereo_mode_names());
                      stereo.mode = *find_stereo_mode(text);
                  });
    declare.value("--stereo-output", joined_by_bar(eye_layout_names()),
                  "how both eyes' pictures are shown and written (side-by-side)", [&stereo](const std::string& text) {
                      check_name("stereo output", "--stereo-output", text, eye_layout_names());
                      stereo.layout = *find_eye_layout(text);
                  });
}

StereoRig stereo_rig_of(const Options& options, const Trace* trace) {
    const StereoOptions& stereo = options.stereo;
    const FovTangents left_fov = stereo.left_fov.value_or(options.camera().fov);
    StereoRig rig = mirrored_rig(stereo.ipd_m, left_fov, stereo.left_turn);
    const bool is_told = stereo.left_fov || options.fov_given;
    if (is_told || trace == nullptr || !trace->eye_fovs()) return rig;
    for (std::size_t i = 0; i < rig.eyes.size(); ++i) rig.eyes[i].fov = (*trace->eye_fovs())[i];
    return rig;
}

Result<std::vector<DrawnView>> drawn_views_of(const Options& options, const Trace* trace) {
    if (!options.stereo.on) return single_view(options.camera());
    return stereo_views(options.camera(), stereo_rig_of(options, trace), options.stereo.mode);
}

Status check_stereo(const Options& options) {
    for (const std::string& baseline : options.baselines) {
        if (find_stereo_mode(baseline) && !options.stereo.on) {
            return Error{"a way to make stereo without stereo", "--baseline " + baseline, "add --eyes stereo"};
        }
    }
    if (!options.stereo.on) return Done{};
    if (options.strips.value_or(1) > 1) {
        return Error{"both eyes' pictures cannot be made in strips", fmt::format("--strips {}", *options.strips),
                     "leave out --strips, or --eyes stereo"};
    }
    const auto views = drawn_views_of(options, nullptr);
    if (!views) return views.error();
    for (const std::string& baseline : options.baselines) {
        const std::optional<StereoMode> mode = find_stereo_mode(baseline);
        if (!mode) continue;
        const auto also = stereo_views(options.camera(), stereo_rig_of(options, nullptr), *mode);
        if (!also) return also.error();
    }
    return Done{};
}

}  // namespace lw
