#include "scene/chairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/chairs_chair.h"
#include "scene/chairs_materials.h"
#include "scene/chairs_scooter.h"
#include "scene/mesh_builder.h"
#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr double kMargin_m = 3.0;  ///< of floor around the objects

int add_mesh(Scene& scene, Mesh mesh) {
    scene.meshes.push_back(std::move(mesh));
    return static_cast<int>(scene.meshes.size()) - 1;
}

int add_node(Scene& scene, std::string name, int parent) {
    Node node;
    node.name = std::move(name);
    node.parent = parent;
    scene.nodes.push_back(std::move(node));
    return static_cast<int>(scene.nodes.size()) - 1;
}

Mesh make_floor(double side_m) {
    MeshBuilder builder{"floor"};
    builder.use_material(kFloor, texture_size_m(kFloor));
    builder.use_colour(tint(0xd8d2c8));
    const double half_m = 0.5 * side_m;
    builder.polygon({{-half_m, 0.0, half_m}, {half_m, 0.0, half_m}, {half_m, 0.0, -half_m}, {-half_m, 0.0, -half_m}});
    return builder.take();
}

std::vector<int> add_chair_meshes(Scene& scene) {
    return {add_mesh(scene, make_chair(tint(0xd9a066), tint(0x8c2f2f))),
            add_mesh(scene, make_chair(tint(0x8a5a38), tint(0xd8c9a8))),
            add_mesh(scene, make_chair(tint(0x5a463c), tint(0x2f5d62)))};
}

std::vector<int> add_scooter_meshes(Scene& scene) {
    return {add_mesh(scene, make_scooter(tint(0xa8d5c8), tint(0x4a2c20))),
            add_mesh(scene, make_scooter(tint(0xc62f2f), tint(0x262220))),
            add_mesh(scene, make_scooter(tint(0xf0e6d0), tint(0x6b3a24))),
            add_mesh(scene, make_scooter(tint(0x2f4f8f), tint(0x30281f)))};
}

/// Uniform over all rotations: Shoemake, "Uniform random rotations", Graphics Gems III, 1992.
glm::dquat random_rotation(Random& random) {
    const double u = random.unit();
    const Direction2 a = direction_of_turns(random.unit());
    const Direction2 b = direction_of_turns(random.unit());
    const double r1 = std::sqrt(1.0 - u);
    const double r2 = std::sqrt(u);
    return {r2 * b.cosine, r1 * a.sine, r1 * a.cosine, r2 * b.sine};
}

/// The height of the object's origin at which its lowest point touches the floor.
double resting_height_m(const Mesh& mesh, const glm::dquat& rotation) {
    double lowest_m = 1e300;
    for (const Vertex& vertex : mesh.vertices) {
        lowest_m = std::min(lowest_m, (rotation * glm::dvec3{vertex.position_object}).y);
    }
    return -lowest_m;
}

/// One turn about the world's vertical in 12-24 s, forever.
void spin(Scene& scene, int node, const glm::dquat& start, double period_s) {
    AnimationChannel channel;
    channel.node = node;
    channel.property = AnimatedProperty::rotation;
    channel.loop_s = period_s;
    constexpr int kKeys = 16;
    for (int k = 0; k <= kKeys; ++k) {
        const Direction2 half = direction_of_turns(0.5 * k / kKeys);
        const glm::dquat turned = glm::dquat{half.cosine, 0.0, half.sine, 0.0} * start;
        channel.times_s.push_back(static_cast<float>(period_s * k / kKeys));
        channel.values.emplace_back(turned.x, turned.y, turned.z, turned.w);
    }
    channel.loop_s = std::max(channel.loop_s, static_cast<double>(channel.times_s.back()));
    scene.channels.push_back(std::move(channel));
}

void strew(Scene& scene, const ChairsParameters& parameters, double side_m) {
    const std::vector<int> chairs = add_chair_meshes(scene);
    const std::vector<int> scooters = add_scooter_meshes(scene);
    const int total = parameters.chairs + parameters.scooters;
    const double reach_m = 0.5 * side_m - kMargin_m;
    for (int i = 0; i < total; ++i) {
        const bool chair = i < parameters.chairs;
        Random random{parameters.seed, static_cast<std::uint64_t>(chair ? i : kMaxChairs + i - parameters.chairs)};
        const int mesh = random.pick(chair ? chairs : scooters);
        const int node = add_node(scene, fmt::format("{} {}", chair ? "chair" : "scooter", i), 0);
        Node& placed = scene.nodes[static_cast<std::size_t>(node)];
        placed.rotation = random_rotation(random);
        placed.translation = {random.between(-reach_m, reach_m), 0.0, random.between(-reach_m, reach_m)};
        placed.translation.y = resting_height_m(scene.meshes[static_cast<std::size_t>(mesh)], placed.rotation);
        // Spread evenly over the objects: i is a multiple of total / movers, rounded down.
        const auto share = [&](int k) { return static_cast<long long>(k) * parameters.movers / std::max(total, 1); };
        if (share(i + 1) > share(i)) spin(scene, node, placed.rotation, random.between(12.0, 24.0));
        scene.instances.push_back({mesh, node, glm::dmat4{1.0}, 0});
    }
}

}  // namespace

double chairs_floor_side_m(int objects) { return 2.75 * std::sqrt(std::max(objects, 1)) + 2.0 * kMargin_m; }

Result<Scene> make_chairs(const ChairsParameters& parameters) {
    const int total = parameters.chairs + parameters.scooters;
    if (parameters.movers > total) {
        return Error{fmt::format("{} movers are too many", parameters.movers), "--param movers",
                     fmt::format("at most the {} objects can move", total)};
    }
    Scene scene;
    scene.name = "chairs";
    add_chairs_materials(scene);
    const int root = add_node(scene, "chairs", kNone);
    const double side_m = chairs_floor_side_m(total);
    const int floor_mesh = add_mesh(scene, make_floor(side_m));
    scene.instances.push_back({floor_mesh, root, glm::dmat4{1.0}, 0});
    strew(scene, parameters, side_m);
    // Outside the front edge at eye height, looking over the floor.
    scene.start_pose = Pose{{0.0, 1.65, 0.5 * side_m + 1.0}, {1.0, 0.0, 0.0, 0.0}};
    scene.sun.direction_to_sun_world = {0.4, 0.75, 0.5};
    scene.finish();
    return scene;
}

}  // namespace lw::scene
