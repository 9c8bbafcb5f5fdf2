#include "scene/gltf_nodes.h"

#include <cmath>
#include <optional>

#include "scene/gltf_accessors.h"
#include "scene/placement.h"

namespace lw::scene {
namespace {

constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr double kShortestQuaternion = 1e-6;

glm::dvec3 vec3_of(const std::vector<double>& numbers, const glm::dvec3& missing) {
    return numbers.size() == 3 ? glm::dvec3{numbers[0], numbers[1], numbers[2]} : missing;
}

/// glTF writes x, y, z, w.
glm::dquat unit_quaternion(GltfSource& source, double x, double y, double z, double w) {
    const glm::dquat rotation{w, x, y, z};
    const double length = glm::length(rotation);
    if (!(length > kShortestQuaternion)) {
        warn_once(source, "rotations without a direction are ignored");
        return {1.0, 0.0, 0.0, 0.0};
    }
    // Exported values are unit within float rounding; leaving the exact ones alone keeps save and load exact.
    return std::abs(length - 1.0) < 1e-15 ? rotation : rotation / length;
}

std::optional<glm::dmat4> matrix_of_node(const tinygltf::Node& from, const std::string& place) {
    if (from.matrix.size() != 16) return std::nullopt;
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = from.matrix[static_cast<std::size_t>(i)];
    if (matrix[0][3] != 0.0 || matrix[1][3] != 0.0 || matrix[2][3] != 0.0 || matrix[3][3] != 1.0) {
        refuse("the matrix is not affine", place + ".matrix");
    }
    return matrix;
}

Node import_node(GltfSource& source, int gltf_node, int parent) {
    const tinygltf::Node& from = source.model.nodes[static_cast<std::size_t>(gltf_node)];
    Node node;
    node.name = from.name;
    node.parent = parent;
    node.translation = vec3_of(from.translation, node.translation);
    node.scale = vec3_of(from.scale, node.scale);
    if (from.rotation.size() == 4) {
        node.rotation = unit_quaternion(source, from.rotation[0], from.rotation[1], from.rotation[2], from.rotation[3]);
    }
    node.matrix = matrix_of_node(from, fmt::format("nodes[{}]", gltf_node));
    return node;
}

/// Placements of EXT_mesh_gpu_instancing.
std::vector<glm::dmat4> instance_placements(GltfSource& source, int gltf_node) {
    const tinygltf::Value& attributes =
        source.model.nodes[static_cast<std::size_t>(gltf_node)].extensions.at(kInstancing).Get("attributes");
    const std::string place = fmt::format("nodes[{}].extensions.{}", gltf_node, kInstancing);
    std::optional<std::size_t> count;
    const auto read = [&](const char* name, int components) {
        if (!attributes.Has(name)) return std::vector<float>{};
        const int accessor = attributes.Get(name).GetNumberAsInt();
        const std::size_t own_count = accessor_count(source, accessor);
        if (count.value_or(own_count) != own_count) refuse("attributes of different length", place);
        count = own_count;
        source.budget.charge(own_count, sizeof(Instance) + sizeof(glm::dmat4), place);
        std::vector<float> values = read_floats(source, accessor, components);
        for (const float value : values) {
            if (!std::isfinite(value)) refuse("a value is not a finite number", place);
        }
        return values;
    };
    const std::vector<float> translations = read("TRANSLATION", 3);
    const std::vector<float> rotations = read("ROTATION", 4);
    const std::vector<float> scales = read("SCALE", 3);
    std::vector<glm::dmat4> placements(count.value_or(0));
    for (std::size_t i = 0; i < placements.size(); ++i) {
        Placement placement;
        if (!translations.empty()) {
            placement.translation = {translations[3 * i], translations[3 * i + 1], translations[3 * i + 2]};
        }
        if (!rotations.empty()) {
            placement.rotation = unit_quaternion(source, rotations[4 * i], rotations[4 * i + 1], rotations[4 * i + 2],
                                                 rotations[4 * i + 3]);
        }
        if (!scales.empty()) placement.scale = {scales[3 * i], scales[3 * i + 1], scales[3 * i + 2]};
        placements[i] = matrix_of(placement);
    }
    return placements;
}

}  // namespace

void import_nodes(GltfSource& source, const NodeOrder& order, Scene& scene) {
    source.budget.charge(order.gltf_nodes.size(), 3 * sizeof(Node), "nodes");
    for (std::size_t i = 0; i < order.gltf_nodes.size(); ++i) {
        scene.nodes.push_back(import_node(source, order.gltf_nodes[i], order.parents[i]));
    }
}

void take_animated_matrices_apart(Scene& scene) {
    for (const AnimationChannel& channel : scene.channels) {
        Node& node = scene.nodes[static_cast<std::size_t>(channel.node)];
        if (!node.matrix) continue;
        const std::optional<Placement> placement = placement_of(*node.matrix);
        if (!placement) refuse("an animated node has a matrix with shear or without a size", "nodes");
        node.matrix.reset();
        node.translation = placement->translation;
        node.rotation = placement->rotation;
        node.scale = placement->scale;
    }
}

void import_instances(GltfSource& source, const NodeOrder& order, const std::vector<int>& scene_mesh, Scene& scene) {
    source.budget.charge(order.gltf_nodes.size(), 3 * sizeof(Instance), "nodes");
    for (std::size_t i = 0; i < order.gltf_nodes.size(); ++i) {
        const int gltf_node = order.gltf_nodes[i];
        const tinygltf::Node& from = source.model.nodes[static_cast<std::size_t>(gltf_node)];
        const int mesh = from.mesh < 0 ? kNone : scene_mesh[static_cast<std::size_t>(from.mesh)];
        if (mesh == kNone) continue;
        Instance instance;
        instance.mesh = mesh;
        instance.node = static_cast<int>(i);
        if (from.extensions.count(kInstancing) == 0) {
            scene.instances.push_back(instance);
            continue;
        }
        for (const glm::dmat4& placement : instance_placements(source, gltf_node)) {
            instance.node_from_object = placement;
            scene.instances.push_back(instance);
        }
    }
}

}  // namespace lw::scene
