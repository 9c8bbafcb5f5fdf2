#pragma once
/// glTF 2.0 in and out (.gltf and .glb).

#include <filesystem>

#include "core/result.h"
#include "scene/scene.h"

namespace lw::scene {

/// Reads a glTF file's default scene. Every index, offset and count is validated before use; a file that claims more
/// than it holds, or more than 512 MB once loaded, is refused. An unknown *required* extension is refused by name.
/// What is drawn differently than written (skins and morph targets in bind pose, blending as mask, points and lines
/// left out) is listed in Scene::warnings, once per kind. The scene is finished (Scene::finish).
[[nodiscard]] Result<Scene> load_gltf(const std::filesystem::path& path);

/// Writes a .glb: meshes, materials, images, nodes, animations and the start pose as a camera. Deterministic: equal
/// scenes give equal bytes.
[[nodiscard]] Status save_glb(const Scene& scene, const std::filesystem::path& path);

}  // namespace lw::scene
