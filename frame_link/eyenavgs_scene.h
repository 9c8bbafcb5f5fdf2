#pragma once
/// Worlds of EyeNavGS recordings: how a splat scene is tilted and scaled (scene_setting.csv).

#include <filesystem>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace lw {

struct EyenavgsScene {
    /// Turns the scene's world upright. This direction was told apart by data: with it the heads of all recordings are
    /// upright on average (mean up vector within 9 degrees of +Y), with its inverse they lean by up to 100 degrees.
    glm::dquat upright_from_scene{1.0, 0.0, 0.0, 0.0};
    double units_per_m = 1.0;
};

/// What a scene_setting.csv says of `scene`; nothing when it does not know it or its row makes no sense. Pure.
[[nodiscard]] std::optional<EyenavgsScene> find_eyenavgs_scene(std::string_view setting_csv, std::string_view scene);

/// "stump" of "user122_stump.csv". Pure.
[[nodiscard]] std::string eyenavgs_scene_name(const std::filesystem::path& recording);

/// The scene_setting.csv beside the recording, or up to two folders above it (where the data set keeps it); empty when
/// there is none.
[[nodiscard]] std::filesystem::path find_scene_setting(const std::filesystem::path& recording);

}  // namespace lw
