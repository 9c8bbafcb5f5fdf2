#include <cmath>

#include "core/check.h"
#include "scene/animation.h"
#include "scene/placement.h"
#include "scene/scene.h"

namespace lw::scene {
namespace {

void apply(const AnimationChannel& channel, double time_s, Placement& local) {
    const glm::dvec4 value = channel_value(channel, time_s);
    switch (channel.property) {
        case AnimatedProperty::translation:
            local.translation = glm::dvec3{value};
            break;
        case AnimatedProperty::rotation:
            local.rotation = glm::dquat{value.w, value.x, value.y, value.z};
            break;
        case AnimatedProperty::scale:
            local.scale = glm::dvec3{value};
            break;
    }
}

}  // namespace

SceneState::SceneState(const Scene& scene) : scene_{&scene}, world_from_node_(scene.nodes.size(), glm::dmat4{1.0}) {
    const std::size_t node_count = scene.nodes.size();
    first_channel_.assign(node_count + 1, 0);
    for (const AnimationChannel& channel : scene.channels) {
        LW_CHECK(channel.node >= 0 && static_cast<std::size_t>(channel.node) < node_count, "channel of no node");
        ++first_channel_[static_cast<std::size_t>(channel.node) + 1];
    }
    for (std::size_t node = 0; node < node_count; ++node) first_channel_[node + 1] += first_channel_[node];
    channels_of_nodes_.resize(scene.channels.size());
    std::vector<std::size_t> next = first_channel_;
    for (std::size_t i = 0; i < scene.channels.size(); ++i) {
        channels_of_nodes_[next[static_cast<std::size_t>(scene.channels[i].node)]++] = i;
    }
    std::vector<bool> changes(node_count, false);
    for (std::size_t node = 0; node < node_count; ++node) {
        const int parent = scene.nodes[node].parent;
        LW_CHECK(parent < static_cast<int>(node), "a parent must come before its children");
        const bool animated = first_channel_[node] != first_channel_[node + 1];
        changes[node] = animated || (parent != kNone && changes[static_cast<std::size_t>(parent)]);
        if (changes[node]) changing_.push_back(node);
    }
}

void SceneState::set_time(double time_s) {
    LW_CHECK(std::isfinite(time_s), "scene time must be finite");
    if (evaluated_) {
        for (const std::size_t node : changing_) evaluate(node, time_s);
        return;
    }
    for (std::size_t node = 0; node < scene_->nodes.size(); ++node) evaluate(node, time_s);
    evaluated_ = true;
}

void SceneState::evaluate(std::size_t i, double time_s) {
    const Node& node = scene_->nodes[i];
    Placement local{node.translation, node.rotation, node.scale};
    for (std::size_t k = first_channel_[i]; k < first_channel_[i + 1]; ++k) {
        apply(scene_->channels[channels_of_nodes_[k]], time_s, local);
    }
    const glm::dmat4 parent_from_node = node.matrix ? *node.matrix : matrix_of(local);
    world_from_node_[i] = node.parent == kNone ? parent_from_node : world_from_node(node.parent) * parent_from_node;
}

void SceneState::mover_placements(std::vector<ObjectTransform>& transforms) const {
    transforms.clear();
    transforms.reserve(scene_->movers.size());
    for (const Mover& mover : scene_->movers) transforms.push_back({mover.id, world_from_node(mover.node)});
}

}  // namespace lw::scene
