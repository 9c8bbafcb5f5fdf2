#include <algorithm>
#include <cmath>
#include <new>

#include "scene/gltf.h"
#include "scene/gltf_animation.h"
#include "scene/gltf_materials.h"
#include "scene/gltf_mesh.h"
#include "scene/gltf_nodes.h"
#include "scene/gltf_source.h"

namespace lw::scene {
namespace {

/// Meshes that nodes of the scene use; per glTF mesh its index in scene.meshes, kNone for unused and empty ones.
std::vector<int> import_meshes(GltfSource& source, const NodeOrder& order, Scene& scene) {
    std::vector<bool> used(source.model.meshes.size(), false);
    for (const int node : order.gltf_nodes) {
        const int mesh = source.model.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh >= 0) used[static_cast<std::size_t>(mesh)] = true;
    }
    MeshFindings findings;
    std::vector<int> scene_mesh(used.size(), kNone);
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i]) continue;
        Mesh mesh = import_mesh(source, static_cast<int>(i), scene.materials, findings);
        if (mesh.primitives.empty()) continue;
        scene_mesh[i] = static_cast<int>(scene.meshes.size());
        scene.meshes.push_back(std::move(mesh));
    }
    if (findings.point_and_line_primitives > 0) {
        warn_once(source, fmt::format("{} point and line primitives are left out", findings.point_and_line_primitives));
    }
    if (findings.primitives_without_positions > 0) {
        warn_once(source,
                  fmt::format("{} primitives without positions are left out", findings.primitives_without_positions));
    }
    if (findings.mended_normals > 0) {
        warn_once(source, fmt::format("{} broken normals are computed anew", findings.mended_normals));
    }
    return scene_mesh;
}

bool finite(const Bounds& bounds) {
    if (bounds.empty()) return true;
    const glm::dvec3 sum = glm::abs(bounds.min) + glm::abs(bounds.max);
    return std::isfinite(sum.x + sum.y + sum.z);
}

Scene import_scene(const std::filesystem::path& path) {
    GltfSource source;
    open_gltf(path, source);
    Scene scene;
    scene.name = path.stem().string();
    const NodeOrder order = order_nodes(source);
    import_nodes(source, order, scene);
    import_materials(source, scene);
    const std::vector<int> scene_mesh = import_meshes(source, order, scene);
    import_animations(source, order.scene_node, scene);
    take_animated_matrices_apart(scene);
    import_instances(source, order, scene_mesh, scene);
    import_lights_and_camera(source, order, scene);
    scene.warnings = std::move(source.warnings);
    scene.finish();
    if (!finite(scene.bounds_world) || !sanitised(*scene.start_pose)) refuse("the model has no finite extent", "nodes");
    return scene;
}

/// Names from the file may hold anything; an error is one printable line.
std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }, '?');
    return text;
}

Error error_of(const GltfRefusal& refusal, const std::filesystem::path& path) {
    const std::string where =
        refusal.place.empty() ? path.string() : fmt::format("{} at {}", path.string(), refusal.place.substr(0, 200));
    return {printable(refusal.what), printable(where), printable(refusal.mend)};
}

}  // namespace

Result<Scene> load_gltf(const std::filesystem::path& path) {
    try {
        return import_scene(path);
    } catch (const GltfRefusal& refusal) {
        return error_of(refusal, path);
    } catch (const std::bad_alloc&) {
        return Error{"not enough memory to load the model", path.string(), "reduce the model or free some memory"};
    } catch (const std::exception& exception) {
        // What a library throws at input we did not foresee.
        return Error{printable(exception.what()), path.string(), "check the file with a glTF validator"};
    }
}

}  // namespace lw::scene
