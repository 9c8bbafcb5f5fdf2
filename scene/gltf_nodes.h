#pragma once
/// glTF node trees -> nodes, instances, lights and the start pose.

#include <vector>

#include "scene/gltf_source.h"
#include "scene/scene.h"

namespace lw::scene {

/// The nodes of the default scene (or the first one; without scenes all), parents before children.
struct NodeOrder {
    std::vector<int> gltf_nodes;  ///< in the order of Scene::nodes
    std::vector<int> parents;     ///< per entry of gltf_nodes: index into gltf_nodes, or kNone
    std::vector<int> scene_node;  ///< per glTF node: index into gltf_nodes, or kNone
    /// Nodes of the scene that carry a camera or a light, left out or not, with the entry of gltf_nodes they hang below
    /// (kNone: the world).
    struct Attachment {
        int gltf_node = kNone;
        int parent = kNone;
    };
    std::vector<Attachment> attachments;
};

/// Keeps the file's own order where parents come first in it. Nodes that carry only a camera or a light are left out
/// if they are leaves and not animated: their place goes into the start pose and the lights. Refuses nodes with two
/// parents, cycles, and scene roots that have a parent (GltfRefusal).
[[nodiscard]] NodeOrder order_nodes(const GltfSource& source);

/// Fills scene.nodes.
void import_nodes(GltfSource& source, const NodeOrder& order, Scene& scene);

/// Gives nodes that have both a matrix and channels a translation, rotation and scale instead, so that the channels
/// have an effect; refuses matrices that are none.
void take_animated_matrices_apart(Scene& scene);

/// Fills scene.instances from the nodes' meshes and EXT_mesh_gpu_instancing. Animations have been imported.
/// @param scene_mesh  per glTF mesh: index into scene.meshes, or kNone where it has no triangles
void import_instances(GltfSource& source, const NodeOrder& order, const std::vector<int>& scene_mesh, Scene& scene);

/// Lights and the first camera, at time 0. Nodes and channels have been imported.
void import_lights_and_camera(GltfSource& source, const NodeOrder& order, Scene& scene);

}  // namespace lw::scene
