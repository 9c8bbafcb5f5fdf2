#pragma once
/// glTF animations -> AnimationChannel.

#include <vector>

#include "scene/gltf_source.h"
#include "scene/scene.h"

namespace lw::scene {

/// Appends the channels of all animations to scene.channels. Each loops over its animation's length, which is its last
/// key; an animation of length 0 holds for a second.
/// @param scene_node  per glTF node its index in scene.nodes, or kNone where the default scene does not hold it
/// Channels of morph weights, of unknown paths and of nodes outside of the scene are left out. Refuses keys that are
/// not finite or not in order, and outputs of the wrong length or type (GltfRefusal).
void import_animations(GltfSource& source, const std::vector<int>& scene_node, Scene& scene);

}  // namespace lw::scene
