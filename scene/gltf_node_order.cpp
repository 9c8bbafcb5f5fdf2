#include <algorithm>
#include <numeric>

#include "scene/gltf_nodes.h"

namespace lw::scene {
namespace {

/// Parent of every glTF node; refuses second parents.
std::vector<int> parents_of(const std::vector<tinygltf::Node>& nodes) {
    std::vector<int> parents(nodes.size(), kNone);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        for (const int child : nodes[i].children) {
            int& parent = parents[static_cast<std::size_t>(child)];
            if (parent != kNone) {
                refuse(fmt::format("node {} has two parents, {} and {}", child, parent, i),
                       fmt::format("nodes[{}].children", i));
            }
            parent = static_cast<int>(i);
        }
    }
    return parents;
}

/// Every node hangs below a root; with one parent each, a node that does not is part of a cycle or hangs below one.
void refuse_cycles(const std::vector<tinygltf::Node>& nodes, const std::vector<int>& parents) {
    std::vector<int> open;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (parents[i] == kNone) open.push_back(static_cast<int>(i));
    }
    std::vector<bool> reached(nodes.size(), false);
    while (!open.empty()) {
        const auto node = static_cast<std::size_t>(open.back());
        open.pop_back();
        reached[node] = true;
        open.insert(open.end(), nodes[node].children.begin(), nodes[node].children.end());
    }
    const auto lost = std::find(reached.begin(), reached.end(), false);
    if (lost != reached.end()) {
        refuse("the node is its own ancestor, or hangs below one that is",
               fmt::format("nodes[{}]", lost - reached.begin()));
    }
}

std::vector<int> roots_of(const GltfSource& source, const std::vector<int>& parents) {
    const tinygltf::Model& model = source.model;
    std::vector<int> roots;
    if (model.scenes.empty()) {
        for (std::size_t i = 0; i < parents.size(); ++i) {
            if (parents[i] == kNone) roots.push_back(static_cast<int>(i));
        }
        return roots;
    }
    const std::size_t scene = model.defaultScene >= 0 ? static_cast<std::size_t>(model.defaultScene) : 0;
    roots = model.scenes[scene].nodes;
    std::vector<bool> seen(parents.size(), false);
    for (std::size_t i = 0; i < roots.size(); ++i) {
        const auto root = static_cast<std::size_t>(roots[i]);
        const std::string place = fmt::format("scenes[{}].nodes[{}]", scene, i);
        if (parents[root] != kNone) refuse(fmt::format("node {} is no root", root), place);
        if (seen[root]) refuse(fmt::format("node {} is there twice", root), place);
        seen[root] = true;
    }
    return roots;
}

std::vector<bool> animated_nodes(const tinygltf::Model& model) {
    std::vector<bool> animated(model.nodes.size(), false);
    for (const tinygltf::Animation& animation : model.animations) {
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            if (channel.target_node >= 0) animated[static_cast<std::size_t>(channel.target_node)] = true;
        }
    }
    return animated;
}

/// Root before child, children in the order of the file.
std::vector<int> preorder(const std::vector<tinygltf::Node>& nodes, const std::vector<int>& roots) {
    std::vector<int> order;
    std::vector<int> open{roots.rbegin(), roots.rend()};
    while (!open.empty()) {
        const int node = open.back();
        open.pop_back();
        order.push_back(node);
        const std::vector<int>& children = nodes[static_cast<std::size_t>(node)].children;
        open.insert(open.end(), children.rbegin(), children.rend());
    }
    return order;
}

}  // namespace

NodeOrder order_nodes(const GltfSource& source) {
    const std::vector<tinygltf::Node>& nodes = source.model.nodes;
    const std::vector<int> parents = parents_of(nodes);
    refuse_cycles(nodes, parents);
    std::vector<int> order = preorder(nodes, roots_of(source, parents));
    const auto after_parent = [&parents](int node) { return parents[static_cast<std::size_t>(node)] < node; };
    if (std::all_of(order.begin(), order.end(), after_parent)) std::sort(order.begin(), order.end());

    const std::vector<bool> animated = animated_nodes(source.model);
    NodeOrder result;
    result.scene_node.assign(nodes.size(), kNone);
    for (const int node : order) {
        const tinygltf::Node& from = nodes[static_cast<std::size_t>(node)];
        const bool carries_light = from.extensions.count("KHR_lights_punctual") != 0;
        const int gltf_parent = parents[static_cast<std::size_t>(node)];
        // A parent has a child, so it was not left out.
        const int parent = gltf_parent == kNone ? kNone : result.scene_node[static_cast<std::size_t>(gltf_parent)];
        const bool attached = from.camera >= 0 || carries_light;
        if (attached) result.attachments.push_back({node, parent});
        if (attached && from.mesh < 0 && from.children.empty() && !animated[static_cast<std::size_t>(node)]) continue;
        result.scene_node[static_cast<std::size_t>(node)] = static_cast<int>(result.gltf_nodes.size());
        result.gltf_nodes.push_back(node);
        result.parents.push_back(parent);
    }
    return result;
}

}  // namespace lw::scene
