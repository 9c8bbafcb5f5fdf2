#include <algorithm>
#include <map>
#include <optional>

#include "scene/gltf_writer.h"
#include "scene/placement.h"

namespace lw::scene {
namespace {

using nlohmann::json;

constexpr int kFloat = 5126;
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kLights = "KHR_lights_punctual";
// Only shown by other programs: a viewer of ours brings its own field of view.
constexpr double kCameraFov_rad = 1.0;
constexpr double kCameraNear_m = 0.05;

json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
json array_of(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

json array_of(const glm::dmat4& matrix) {
    json numbers = json::array();
    for (int i = 0; i < 16; ++i) numbers.push_back(matrix[i / 4][i % 4]);
    return numbers;
}

json node_json(const Node& node) {
    json object = json::object();
    if (!node.name.empty()) object["name"] = node.name;
    if (node.matrix) {
        object["matrix"] = array_of(*node.matrix);
        return object;
    }
    if (node.translation != glm::dvec3{0.0}) object["translation"] = array_of(node.translation);
    if (node.rotation != glm::dquat{1.0, 0.0, 0.0, 0.0}) object["rotation"] = array_of(node.rotation);
    if (node.scale != glm::dvec3{1.0}) object["scale"] = array_of(node.scale);
    return object;
}

/// Instances of one mesh at one node.
using Placements = std::vector<glm::dmat4>;

bool is_plain(const Placements& placements) { return placements.size() == 1 && placements[0] == glm::dmat4{1.0}; }

int add_floats(const std::vector<float>& floats, std::size_t components, const char* type, GltfWriter& writer) {
    return writer.add_accessor(writer.add_view(std::as_bytes(std::span{floats})), 0, kFloat, floats.size() / components,
                               type);
}

/// EXT_mesh_gpu_instancing; nothing where a placement has shear.
std::optional<json> instancing_json(const Placements& placements, GltfWriter& writer) {
    std::vector<float> translations;
    std::vector<float> rotations;
    std::vector<float> scales;
    for (const glm::dmat4& matrix : placements) {
        const std::optional<Placement> placement = placement_of(matrix);
        if (!placement) return std::nullopt;
        for (glm::length_t i = 0; i < 3; ++i) translations.push_back(static_cast<float>(placement->translation[i]));
        const glm::quat rotation{placement->rotation};
        rotations.insert(rotations.end(), {rotation.x, rotation.y, rotation.z, rotation.w});
        for (glm::length_t i = 0; i < 3; ++i) scales.push_back(static_cast<float>(placement->scale[i]));
    }
    return json{{"attributes",
                 {{"TRANSLATION", add_floats(translations, 3, "VEC3", writer)},
                  {"ROTATION", add_floats(rotations, 4, "VEC4", writer)},
                  {"SCALE", add_floats(scales, 3, "VEC3", writer)}}}};
}

/// Puts a mesh onto the node object, once or many times. False where only nodes of their own can hold the placements.
bool put_on_node(int mesh, const Placements& placements, json& node, GltfWriter& writer) {
    if (!is_plain(placements)) {
        std::optional<json> instancing = instancing_json(placements, writer);
        if (!instancing) return false;
        node["extensions"][kInstancing] = std::move(*instancing);
        writer.use_extension(kInstancing);
    }
    node["mesh"] = mesh;
    return true;
}

/// A glTF node holds one mesh: the first group of instances goes onto the node itself, others onto children of it.
void write_instances(const Scene& scene, const std::vector<int>& gltf_mesh, std::vector<json>& nodes,
                     GltfWriter& writer) {
    std::map<std::pair<int, int>, Placements> groups;  // by node and mesh
    for (const Instance& instance : scene.instances) {
        const int mesh = gltf_mesh[static_cast<std::size_t>(instance.mesh)];
        if (mesh != kNone) groups[{instance.node, mesh}].push_back(instance.node_from_object);
    }
    for (const auto& [node_and_mesh, placements] : groups) {
        const auto node = static_cast<std::size_t>(node_and_mesh.first);
        if (!nodes[node].contains("mesh") && put_on_node(node_and_mesh.second, placements, nodes[node], writer)) {
            continue;
        }
        json child = json::object();
        if (put_on_node(node_and_mesh.second, placements, child, writer)) {
            nodes[node]["children"].push_back(nodes.size());
            nodes.push_back(std::move(child));
            continue;
        }
        for (const glm::dmat4& placement : placements) {
            nodes[node]["children"].push_back(nodes.size());
            nodes.push_back({{"mesh", node_and_mesh.second}, {"matrix", array_of(placement)}});
        }
    }
}

/// A light's colour has components up to 1; its brightness is apart.
json light_json(const char* type, const glm::vec3& brightness) {
    const double intensity = std::max({brightness.x, brightness.y, brightness.z, 0.0f});
    json light = {{"type", type}, {"intensity", intensity}};
    if (intensity > 0.0) light["color"] = array_of(glm::dvec3{brightness} / intensity);
    return light;
}

/// Turns +Z to `direction`: lights shine along -Z.
glm::dquat rotation_from_z_to(const glm::dvec3& direction) {
    const glm::dvec3 z{0.0, 0.0, 1.0};
    if (glm::dot(z, direction) < -0.999999) return {0.0, 0.0, 1.0, 0.0};  // half a turn about Y
    const glm::dvec3 axis = glm::cross(z, direction);
    return glm::normalize(glm::dquat{1.0 + glm::dot(z, direction), axis.x, axis.y, axis.z});
}

void write_lights(const Scene& scene, std::vector<json>& nodes, GltfWriter& writer) {
    json lights = json::array();
    const auto add = [&](json light, json node) {
        node["extensions"][kLights] = {{"light", lights.size()}};
        lights.push_back(std::move(light));
        nodes.push_back(std::move(node));
    };
    add(light_json("directional", scene.sun.irradiance),
        {{"name", "sun"},
         {"rotation", array_of(rotation_from_z_to(glm::normalize(scene.sun.direction_to_sun_world)))}});
    for (const PointLight& light : scene.point_lights) {
        json object = light_json("point", light.intensity);
        object["range"] = light.range_m;
        add(std::move(object), {{"translation", array_of(light.position_world)}});
    }
    writer.root["extensions"][kLights]["lights"] = std::move(lights);
    writer.use_extension(kLights);
}

void write_start_pose(const Scene& scene, std::vector<json>& nodes, GltfWriter& writer) {
    if (!scene.start_pose) return;
    writer.add("cameras",
               {{"type", "perspective"}, {"perspective", {{"yfov", kCameraFov_rad}, {"znear", kCameraNear_m}}}});
    nodes.push_back({{"name", "start"},
                     {"camera", 0},
                     {"translation", array_of(scene.start_pose->position_m)},
                     {"rotation", array_of(scene.start_pose->orientation)}});
}

}  // namespace

void write_nodes(const Scene& scene, const std::vector<int>& gltf_mesh, GltfWriter& writer) {
    std::vector<json> nodes;
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        nodes.push_back(node_json(scene.nodes[i]));
        const int parent = scene.nodes[i].parent;
        if (parent == kNone) {
            roots.push_back(i);
        } else {
            nodes[static_cast<std::size_t>(parent)]["children"].push_back(i);
        }
    }
    write_instances(scene, gltf_mesh, nodes, writer);
    const std::size_t first_attachment = nodes.size();
    write_lights(scene, nodes, writer);
    write_start_pose(scene, nodes, writer);
    for (std::size_t i = first_attachment; i < nodes.size(); ++i) roots.push_back(i);
    writer.root["nodes"] = std::move(nodes);
    json gltf_scene = {{"nodes", std::move(roots)}};
    if (!scene.name.empty()) gltf_scene["name"] = scene.name;
    writer.add("scenes", std::move(gltf_scene));
    writer.root["scene"] = 0;
}

}  // namespace lw::scene
