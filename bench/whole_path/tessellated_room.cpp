#include "bench/whole_path/tessellated_room.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace lw::bench {
namespace {

constexpr int kBoxesPerRow = 7;
constexpr int kBoxRows = 7;
constexpr int kFacesPerBox = 5;  // the bottom stands on the floor
constexpr std::uint64_t kFaces = 1 + kBoxesPerRow * kBoxRows * kFacesPerBox;
constexpr double kEyeHeight_m = 1.6;

// A square of 2 x 2, facing +Z, of cells x cells x 2 triangles.
scene::Mesh square(int cells) {
    scene::Mesh mesh;
    const auto side = static_cast<std::uint32_t>(cells + 1);
    for (std::uint32_t y = 0; y < side; ++y) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const glm::vec2 part = glm::vec2{x, y} / static_cast<float>(cells);
            scene::Vertex vertex;
            vertex.position_object = {2.0f * part - 1.0f, 0.0f};
            vertex.normal_object = {0.0f, 0.0f, 1.0f};
            vertex.uv = part;
            mesh.vertices.push_back(vertex);
        }
    }
    for (std::uint32_t y = 0; y + 1 < side; ++y) {
        for (std::uint32_t x = 0; x + 1 < side; ++x) {
            const std::uint32_t a = y * side + x;
            for (const std::uint32_t corner : {a, a + 1, a + side + 1, a, a + side + 1, a + side}) {
                mesh.indices.push_back(corner);
            }
        }
    }
    mesh.primitives = {{0, static_cast<std::uint32_t>(mesh.indices.size()), 0}};
    return mesh;
}

scene::TextureImage tiles() {
    constexpr int kSide_px = 128;
    scene::TextureImage image{"tiles", ColourImage{{kSide_px, kSide_px}}};
    for (int y = 0; y < kSide_px; ++y) {
        for (int x = 0; x < kSide_px; ++x) {
            const bool dark = ((x / 16) + (y / 16)) % 2 == 0;
            const auto wave = static_cast<int>(30.0 * std::sin(0.21 * x) * std::cos(0.17 * y));
            const auto level = static_cast<std::uint8_t>((dark ? 90 : 190) + wave);
            image.pixels.at(x, y) = {level, static_cast<std::uint8_t>(level / 2 + 40), 90, 255};
        }
    }
    return image;
}

void add_face(scene::Scene& scene, const glm::dmat4& world_from_object) {
    scene::Node node;
    node.matrix = world_from_object;
    scene.nodes.push_back(node);
    scene.instances.push_back({0, static_cast<int>(scene.nodes.size()) - 1, glm::dmat4{1.0}, 0});
}

// Faces of a box around the origin that reaches from -1 to 1, each turned out of +Z, without the bottom.
void add_box(scene::Scene& scene, const glm::dmat4& world_from_box) {
    constexpr double kQuarter = std::numbers::pi / 2.0;
    for (int side = 0; side < kFacesPerBox; ++side) {
        const glm::dvec3 axis = side < 4 ? glm::dvec3{0.0, 1.0, 0.0} : glm::dvec3{1.0, 0.0, 0.0};
        const glm::dmat4 turn = glm::rotate(glm::dmat4{1.0}, side < 4 ? side * kQuarter : -kQuarter, axis);
        add_face(scene, world_from_box * turn * glm::translate(glm::dmat4{1.0}, glm::dvec3{0.0, 0.0, 1.0}));
    }
}

}  // namespace

scene::Scene tessellated_room(std::uint64_t triangles) {
    scene::Scene scene;
    scene.name = "tessellated room";
    scene.images = {tiles()};
    scene::Material material;
    material.base_colour_texture.image = 0;
    material.metallic = 0.0f;
    scene.materials = {material};
    const double cells = std::sqrt(static_cast<double>(triangles) / (2.0 * static_cast<double>(kFaces)));
    scene.meshes = {square(static_cast<int>(std::ceil(cells)))};
    const glm::dmat4 lie_down = glm::rotate(glm::dmat4{1.0}, -std::numbers::pi / 2.0, glm::dvec3{1.0, 0.0, 0.0});
    add_face(scene, lie_down * glm::scale(glm::dmat4{1.0}, glm::dvec3{15.0, 15.0, 1.0}));
    for (int row = 0; row < kBoxRows; ++row) {
        for (int i = 0; i < kBoxesPerRow; ++i) {
            const glm::dvec3 centre{(i - 3) * 1.7, 0.3 + 0.1 * ((row + i) % 3), -3.0 - 1.7 * row};
            const glm::dmat4 placed = glm::translate(glm::dmat4{1.0}, centre);
            const glm::dmat4 turned = glm::rotate(placed, 0.3 * (row + 2 * i), glm::dvec3{0.0, 1.0, 0.0});
            add_box(scene, glm::scale(turned, glm::dvec3{0.35, centre.y, 0.35}));
        }
    }
    scene.start_pose = Pose{{0.0, kEyeHeight_m, 0.0}, glm::dquat{1.0, 0.0, 0.0, 0.0}};
    scene.finish();
    return scene;
}

Camera room_camera(glm::ivec2 size_px) {
    Camera camera;
    camera.size_px = size_px;
    camera.fov = FovTangents::symmetric(std::numbers::pi / 2.0, static_cast<double>(size_px.x) / size_px.y);
    camera.world_from_eye.position_m = {0.0, kEyeHeight_m, 0.0};
    return camera;
}

}  // namespace lw::bench
