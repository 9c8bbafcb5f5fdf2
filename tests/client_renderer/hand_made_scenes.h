#pragma once
/// Tiny scenes whose pictures can be worked out by hand.

#include "scene/scene.h"

namespace lw::test {

/// A square of side 2 in the plane z = 0 of its object, facing +Z, uv (0, 0) at its upper left corner.
[[nodiscard]] inline scene::Mesh square_mesh(int material) {
    scene::Mesh mesh;
    for (const glm::vec2& corner : {glm::vec2{-1, -1}, glm::vec2{1, -1}, glm::vec2{1, 1}, glm::vec2{-1, 1}}) {
        scene::Vertex vertex;
        vertex.position_object = {corner, 0.0f};
        vertex.normal_object = {0.0f, 0.0f, 1.0f};
        vertex.uv = {0.5f * corner.x + 0.5f, 0.5f - 0.5f * corner.y};
        mesh.vertices.push_back(vertex);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    mesh.primitives = {{0, 6, material}};
    return mesh;
}

[[nodiscard]] inline scene::Material unlit_material(const glm::vec4& colour) {
    scene::Material material;
    material.base_colour = colour;
    material.unlit = true;
    return material;
}

/// Adds a node with an instance of `mesh`.
inline int add_instance(scene::Scene& scene, int mesh, const glm::dmat4& world_from_object) {
    scene::Node node;
    node.matrix = world_from_object;
    scene.nodes.push_back(node);
    const int index = static_cast<int>(scene.nodes.size()) - 1;
    scene.instances.push_back({mesh, index, glm::dmat4{1.0}, 0});
    return index;
}

/// At the origin, looking along -Z, 90 degrees.
[[nodiscard]] inline Camera plain_camera(glm::ivec2 size_px) {
    Camera camera;
    camera.size_px = size_px;
    const double aspect = static_cast<double>(size_px.x) / size_px.y;
    camera.fov = {-aspect, aspect, -1.0, 1.0};
    return camera;
}

}  // namespace lw::test
