#pragma once
/// Scenes made by code: nothing is downloaded, equal parameters give equal bytes.

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "scene/scene.h"

namespace lw::scene {

/// `--param key=value` pairs.
using Parameters = std::map<std::string, double, std::less<>>;

struct BuiltInScene {
    std::string_view name;
    std::string_view summary;
    std::string_view parameters;  ///< "buildings, seed, movers"
};
[[nodiscard]] std::vector<BuiltInScene> built_in_scenes();

/// Unknown names, unknown keys and values outside their range are errors. The scene is finished.
[[nodiscard]] Result<Scene> make_built_in(std::string_view name, const Parameters& parameters);

/// A built-in name or a .gltf / .glb path.
[[nodiscard]] Result<Scene> load_scene(const std::string& name_or_path, const Parameters& parameters);

}  // namespace lw::scene
