#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw::scene {
namespace {

constexpr double kEyeHeight_m = 1.6;
constexpr std::size_t kMaxMovers = 65535;  // ids are 16 bit and 0 is the static world

/// Per node: the nearest animated node among itself and its ancestors, or kNone.
std::vector<int> nearest_animated_nodes(const Scene& scene) {
    std::vector<int> nearest(scene.nodes.size(), kNone);
    for (const AnimationChannel& channel : scene.channels)
        nearest[static_cast<std::size_t>(channel.node)] = channel.node;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        const int parent = scene.nodes[i].parent;
        if (nearest[i] == kNone && parent != kNone) nearest[i] = nearest[static_cast<std::size_t>(parent)];
    }
    return nearest;
}

void derive_movers(Scene& scene) {
    const std::vector<int> nearest = nearest_animated_nodes(scene);
    std::vector<bool> carries(scene.nodes.size(), false);
    for (const Instance& instance : scene.instances) {
        const int node = nearest[static_cast<std::size_t>(instance.node)];
        if (node != kNone) carries[static_cast<std::size_t>(node)] = true;
    }
    scene.movers.clear();
    std::vector<ObjectId> id_of_node(scene.nodes.size(), 0);
    std::size_t left_static = 0;
    for (std::size_t node = 0; node < carries.size(); ++node) {
        if (!carries[node]) continue;
        if (scene.movers.size() == kMaxMovers) {
            ++left_static;
            continue;
        }
        id_of_node[node] = static_cast<ObjectId>(scene.movers.size() + 1);
        scene.movers.push_back({id_of_node[node], static_cast<int>(node)});
    }
    for (Instance& instance : scene.instances) {
        const int node = nearest[static_cast<std::size_t>(instance.node)];
        instance.mover = node == kNone ? ObjectId{0} : id_of_node[static_cast<std::size_t>(node)];
    }
    if (left_static > 0) {
        scene.warnings.push_back(
            fmt::format("{} moving objects beyond the first {} are warped as if static", left_static, kMaxMovers));
    }
}

void derive_bounds(Scene& scene) {
    for (Mesh& mesh : scene.meshes) {
        mesh.bounds = {};
        for (const Vertex& vertex : mesh.vertices) mesh.bounds.include(glm::dvec3{vertex.position_object});
    }
    SceneState state{scene};
    state.set_time(0.0);
    scene.bounds_world = {};
    for (const Instance& instance : scene.instances) {
        const Mesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        scene.bounds_world.include(transformed(mesh.bounds, state.world_from_object(instance)));
    }
}

/// Orientation of an eye that looks along `direction` with +Y up; straight up and down keep -Z as the upper edge.
glm::dquat orientation_looking_along(const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (!(length > 1e-9)) return {1.0, 0.0, 0.0, 0.0};
    const glm::dvec3 back = -direction / length;
    glm::dvec3 right = glm::cross(glm::dvec3{0.0, 1.0, 0.0}, back);
    right = glm::length(right) > 1e-9 ? glm::normalize(right) : glm::dvec3{1.0, 0.0, 0.0};
    return glm::normalize(glm::quat_cast(glm::dmat3{right, glm::cross(back, right), back}));
}

/// At the middle of the +Z edge of the bounds, looking at their centre. A scene lower than two eye heights is looked at
/// from its middle height, and from half its larger side before the edge, so that it fits a view of 90 degrees.
Pose default_start_pose(const Bounds& bounds) {
    if (bounds.empty()) return {};
    const glm::dvec3 centre = bounds.centre();
    const glm::dvec3 half = bounds.half_size();
    glm::dvec3 eye{centre.x, bounds.min.y + std::min(kEyeHeight_m, half.y), bounds.max.z};
    if (half.y < kEyeHeight_m) eye.z += std::max({half.x, half.y, 0.1});
    return {eye, orientation_looking_along(centre - eye)};
}

}  // namespace

Bounds transformed(const Bounds& bounds, const glm::dmat4& to_from) {
    if (bounds.empty()) return bounds;
    const glm::dmat3 linear{to_from};
    const glm::dmat3 magnitude{glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2])};
    const glm::dvec3 centre = linear * bounds.centre() + glm::dvec3{to_from[3]};
    const glm::dvec3 half = magnitude * bounds.half_size();
    return {centre - half, centre + half};
}

void Scene::finish() {
    for (const AnimationChannel& channel : channels) {
        LW_CHECK(channel.node >= 0 && static_cast<std::size_t>(channel.node) < nodes.size(), "channel of no node");
    }
    for (const Instance& instance : instances) {
        LW_CHECK(instance.node >= 0 && static_cast<std::size_t>(instance.node) < nodes.size(), "instance of no node");
        LW_CHECK(instance.mesh >= 0 && static_cast<std::size_t>(instance.mesh) < meshes.size(), "instance of no mesh");
    }
    derive_movers(*this);
    derive_bounds(*this);
    const double sun_length = glm::length(sun.direction_to_sun_world);
    sun.direction_to_sun_world =
        sun_length > 1e-9 ? sun.direction_to_sun_world / sun_length : glm::dvec3{0.0, 1.0, 0.0};
    if (point_lights.size() > static_cast<std::size_t>(kMaxPointLights)) {
        warnings.push_back(fmt::format("{} point lights beyond the first {} are off",
                                       point_lights.size() - kMaxPointLights, kMaxPointLights));
        point_lights.resize(static_cast<std::size_t>(kMaxPointLights));
    }
    if (!start_pose) start_pose = default_start_pose(bounds_world);
}

std::uint64_t Scene::triangle_count() const {
    std::uint64_t count = 0;
    for (const Instance& instance : instances) {
        for (const Primitive& primitive : meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
            count += primitive.index_count / 3;
        }
    }
    return count;
}

}  // namespace lw::scene
