// load(save(scene)) keeps what a scene holds.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "scene/placement.h"
#include "tests/scene/gltf_builder.h"
#include "tests/support/shared_data.h"

namespace lw::scene {
namespace {

// Where values pass through float or through a product and a quotient: a few units in the last place.
constexpr float kFloatTolerance = 1e-6f;

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

void expect_same_use(const TextureUse& a, const TextureUse& b) {
    EXPECT_EQ(a.image, b.image);
    if (a.image == kNone) return;
    EXPECT_EQ(a.wrap_u, b.wrap_u);
    EXPECT_EQ(a.wrap_v, b.wrap_v);
    EXPECT_EQ(a.nearest, b.nearest);
    for (int i = 0; i < 3; ++i) EXPECT_LT(glm::length(a.uv_transform[i] - b.uv_transform[i]), kFloatTolerance);
}

void expect_same_materials(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.images.size(), b.images.size());
    for (std::size_t i = 0; i < a.images.size(); ++i) {
        EXPECT_EQ(a.images[i].name, b.images[i].name);
        EXPECT_TRUE(a.images[i].pixels == b.images[i].pixels);
    }
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        const Material& x = a.materials[i];
        const Material& y = b.materials[i];
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.base_colour, y.base_colour);
        EXPECT_EQ(x.metallic, y.metallic);
        EXPECT_EQ(x.roughness, y.roughness);
        EXPECT_LT(glm::length(x.emissive - y.emissive), kFloatTolerance * (1.0f + glm::length(x.emissive)));
        EXPECT_EQ(x.alpha_cutoff, y.alpha_cutoff);
        EXPECT_EQ(x.double_sided, y.double_sided);
        EXPECT_EQ(x.unlit, y.unlit);
        if (x.normal_texture.image != kNone) {
            EXPECT_EQ(x.normal_scale, y.normal_scale);
        }
        expect_same_use(x.base_colour_texture, y.base_colour_texture);
        expect_same_use(x.metallic_roughness_texture, y.metallic_roughness_texture);
        expect_same_use(x.normal_texture, y.normal_texture);
        expect_same_use(x.emissive_texture, y.emissive_texture);
    }
}

void expect_same_meshes(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        SCOPED_TRACE(i);
        const Mesh& x = a.meshes[i];
        const Mesh& y = b.meshes[i];
        EXPECT_EQ(x.name, y.name);
        EXPECT_EQ(x.indices, y.indices);
        ASSERT_EQ(x.vertices.size(), y.vertices.size());
        for (std::size_t v = 0; v < x.vertices.size(); ++v) {
            ASSERT_EQ(x.vertices[v].position_object, y.vertices[v].position_object);
            // Made unit vectors again.
            ASSERT_LT(glm::length(x.vertices[v].normal_object - y.vertices[v].normal_object), kFloatTolerance);
            ASSERT_LT(glm::length(x.vertices[v].tangent_object - y.vertices[v].tangent_object), kFloatTolerance);
            ASSERT_EQ(x.vertices[v].uv, y.vertices[v].uv);
            ASSERT_EQ(x.vertices[v].colour, y.vertices[v].colour);
        }
        ASSERT_EQ(x.primitives.size(), y.primitives.size());
        for (std::size_t p = 0; p < x.primitives.size(); ++p) {
            EXPECT_EQ(x.primitives[p].first_index, y.primitives[p].first_index);
            EXPECT_EQ(x.primitives[p].index_count, y.primitives[p].index_count);
            EXPECT_EQ(x.primitives[p].material, y.primitives[p].material);
        }
    }
}

void expect_same_nodes(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        EXPECT_EQ(a.nodes[i].name, b.nodes[i].name);
        EXPECT_EQ(a.nodes[i].parent, b.nodes[i].parent);
        EXPECT_EQ(a.nodes[i].matrix, b.nodes[i].matrix);
        if (a.nodes[i].matrix) continue;
        EXPECT_EQ(a.nodes[i].translation, b.nodes[i].translation);
        EXPECT_EQ(a.nodes[i].scale, b.nodes[i].scale);
        EXPECT_LT(glm::length(a.nodes[i].rotation - b.nodes[i].rotation), 1e-14);  // made a unit quaternion again
    }
    ASSERT_EQ(a.instances.size(), b.instances.size());
    for (std::size_t i = 0; i < a.instances.size(); ++i) {
        EXPECT_EQ(a.instances[i].mesh, b.instances[i].mesh);
        EXPECT_EQ(a.instances[i].node, b.instances[i].node);
        EXPECT_EQ(a.instances[i].mover, b.instances[i].mover);
        for (int column = 0; column < 4; ++column) {
            // EXT_mesh_gpu_instancing holds floats.
            const glm::dvec4 x = a.instances[i].node_from_object[column];
            EXPECT_LT(glm::length(x - b.instances[i].node_from_object[column]), 1e-6 * (1.0 + glm::length(x)));
        }
    }
}

void expect_same_animations(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.channels.size(), b.channels.size());
    for (std::size_t i = 0; i < a.channels.size(); ++i) {
        EXPECT_EQ(a.channels[i].node, b.channels[i].node);
        EXPECT_EQ(a.channels[i].property, b.channels[i].property);
        EXPECT_EQ(a.channels[i].interpolation, b.channels[i].interpolation);
        EXPECT_EQ(a.channels[i].times_s, b.channels[i].times_s);
        EXPECT_EQ(a.channels[i].values, b.channels[i].values);
        EXPECT_NEAR(a.channels[i].loop_s, b.channels[i].loop_s, 1e-6 * a.channels[i].loop_s);  // the last key's float
    }
    ASSERT_EQ(a.movers.size(), b.movers.size());
    for (std::size_t i = 0; i < a.movers.size(); ++i) EXPECT_EQ(a.movers[i].node, b.movers[i].node);
}

void expect_same_surroundings(const Scene& a, const Scene& b) {
    EXPECT_LT(glm::length(a.sun.irradiance - b.sun.irradiance), kFloatTolerance * glm::length(a.sun.irradiance));
    EXPECT_LT(glm::length(a.sun.direction_to_sun_world - b.sun.direction_to_sun_world), 1e-12);
    ASSERT_EQ(a.point_lights.size(), b.point_lights.size());
    for (std::size_t i = 0; i < a.point_lights.size(); ++i) {
        EXPECT_EQ(a.point_lights[i].position_world, b.point_lights[i].position_world);
        EXPECT_EQ(a.point_lights[i].range_m, b.point_lights[i].range_m);
        EXPECT_LT(glm::length(a.point_lights[i].intensity - b.point_lights[i].intensity),
                  kFloatTolerance * glm::length(a.point_lights[i].intensity));
    }
    EXPECT_LT(glm::length(a.start_pose->position_m - b.start_pose->position_m), 1e-12);
    EXPECT_LT(angle_between_rad(a.start_pose->orientation, b.start_pose->orientation), 1e-12);
}

void expect_same(const Scene& a, const Scene& b) {
    expect_same_materials(a, b);
    expect_same_meshes(a, b);
    expect_same_nodes(a, b);
    expect_same_animations(a, b);
    expect_same_surroundings(a, b);
}

/// Two quads in one mesh with materials of their own.
Mesh two_quads() {
    Mesh mesh;
    mesh.name = "quads";
    for (int quad = 0; quad < 2; ++quad) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        for (int corner = 0; corner < 4; ++corner) {
            Vertex vertex;
            vertex.position_object = {0.1f + static_cast<float>(corner & 1), static_cast<float>(corner / 2),
                                      static_cast<float>(quad)};
            vertex.normal_object = {0.0f, 0.0f, 1.0f};
            vertex.tangent_object = {0.6f, 0.8f, 0.0f, quad == 0 ? 1.0f : -1.0f};
            vertex.uv = {static_cast<float>(corner & 1), 1.0f - static_cast<float>(corner / 2)};
            vertex.colour = {255, static_cast<std::uint8_t>(corner * 80), 7, 200};
            mesh.vertices.push_back(vertex);
        }
        mesh.primitives.push_back({static_cast<std::uint32_t>(mesh.indices.size()), 6, quad});
        for (const std::uint32_t corner : {0u, 1u, 2u, 2u, 1u, 3u}) mesh.indices.push_back(first + corner);
    }
    return mesh;
}

Material full_material() {
    Material material;
    material.name = "full";
    material.base_colour = {0.1f, 0.2f, 0.3f, 0.4f};
    material.metallic = 0.25f;
    material.roughness = 0.75f;
    material.emissive = {0.5f, 2.0f, 4.0f};
    material.normal_scale = 0.5f;
    material.alpha_cutoff = 0.3f;
    material.double_sided = true;
    material.base_colour_texture.image = 0;
    material.base_colour_texture.wrap_u = TextureWrap::clamp;
    material.base_colour_texture.wrap_v = TextureWrap::mirror;
    const float cosine = std::cos(0.7f);
    const float sine = std::sin(0.7f);
    material.base_colour_texture.uv_transform =
        glm::mat3{glm::vec3{2.0f * cosine, -2.0f * sine, 0.0f}, glm::vec3{-3.0f * sine, -3.0f * cosine, 0.0f},
                  glm::vec3{0.25f, -0.5f, 1.0f}};
    material.metallic_roughness_texture.image = 1;
    material.metallic_roughness_texture.nearest = true;
    material.normal_texture.image = 1;
    material.emissive_texture.image = 0;
    return material;
}

AnimationChannel channel_of(int node, AnimatedProperty property, Interpolation interpolation, double loop_s) {
    AnimationChannel channel;
    channel.node = node;
    channel.property = property;
    channel.interpolation = interpolation;
    channel.loop_s = loop_s;
    channel.times_s = {0.0f, 0.5f, static_cast<float>(loop_s)};
    const std::size_t values = interpolation == Interpolation::cubic ? 9 : 3;
    for (std::size_t i = 0; i < values; ++i) {
        channel.values.push_back(property == AnimatedProperty::rotation
                                     ? glm::vec4{0.0f, 0.6f, 0.0f, 0.8f}
                                     : glm::vec4{1.0f, 0.25f * static_cast<float>(i + 1), 2.0f, 0.0f});
    }
    return channel;
}

Scene full_scene() {
    Scene scene;
    scene.name = "full";
    ColourImage small{{3, 2}};
    small.at(1, 1) = {10, 20, 30, 40};
    scene.images = {{"first", small}, {"second", ColourImage{{1, 1}, {1, 2, 3, 255}}}};
    Material plain;
    plain.unlit = true;
    scene.materials = {full_material(), plain};
    scene.meshes = {two_quads()};
    scene.nodes.resize(4);
    scene.nodes[0].name = "root";
    scene.nodes[0].translation = {1.0 / 3.0, 2.0, 3.0};
    scene.nodes[1].parent = 0;
    scene.nodes[1].rotation = glm::angleAxis(0.3, glm::normalize(glm::dvec3{1, 1, 0}));
    scene.nodes[1].scale = {-1.0, 2.0, 0.1};
    scene.nodes[2].matrix = matrix_of(Placement{{1, 2, 3}, {1, 0, 0, 0}, {2, 2, 2}});
    scene.nodes[2].matrix->operator[](1)[0] = 0.5;  // shear, which only a matrix can hold
    scene.nodes[3].parent = 1;
    scene.instances.resize(5);
    scene.instances[1].node = 1;
    for (std::size_t i = 2; i < 5; ++i) {
        scene.instances[i].node = 2;
        scene.instances[i].node_from_object =
            matrix_of(Placement{{static_cast<double>(i), 0.1, 0}, glm::angleAxis(0.2, glm::dvec3{0, 1, 0}), {1, 2, 1}});
    }
    scene.channels = {channel_of(1, AnimatedProperty::translation, Interpolation::linear, 2.0),
                      channel_of(1, AnimatedProperty::rotation, Interpolation::step, 2.0),
                      channel_of(3, AnimatedProperty::scale, Interpolation::cubic, 3.5)};
    scene.sun.irradiance = {1.0f, 2.0f, 3.0f};
    scene.point_lights = {{{1, 2, 3}, {10.0f, 5.0f, 1.0f}, 7.5f}, {{-1, 0, 0}, {0.25f, 0.5f, 0.125f}, 3.0f}};
    scene.start_pose = Pose{{0.1, 1.6, -2.0}, glm::angleAxis(0.4, glm::dvec3{0, 1, 0})};
    scene.finish();
    return scene;
}

TEST(GltfRoundTrip, KeepsEverythingASceneHolds) {
    const Scene scene = full_scene();
    const auto path = test::test_folder() / "full.glb";
    const Status saved = save_glb(scene, path);
    ASSERT_TRUE(saved.ok()) << saved.error().message();
    const auto again = load_gltf(path);
    ASSERT_TRUE(again.ok()) << again.error().message();
    EXPECT_TRUE(again->warnings.empty()) << again->warnings.front();
    expect_same(scene, *again);
}

TEST(GltfRoundTrip, EqualScenesGiveEqualBytes) {
    const auto first = test::test_folder() / "first.glb";
    const auto second = test::test_folder() / "second.glb";
    ASSERT_TRUE(save_glb(full_scene(), first).ok());
    ASSERT_TRUE(save_glb(full_scene(), second).ok());
    EXPECT_FALSE(bytes_of(first).empty());
    EXPECT_EQ(bytes_of(first), bytes_of(second));
}

TEST(GltfRoundTrip, ASecondSaveIsTheSameFile) {
    const auto first = test::test_folder() / "first.glb";
    const auto second = test::test_folder() / "second.glb";
    ASSERT_TRUE(save_glb(full_scene(), first).ok());
    auto scene = load_gltf(first);
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    scene->name = "full";
    ASSERT_TRUE(save_glb(*scene, second).ok());
    const auto again = load_gltf(second);
    ASSERT_TRUE(again.ok()) << again.error().message();
    expect_same(*scene, *again);
}

TEST(GltfRoundTrip, AChannelShorterThanItsLoopHoldsItsLastValue) {
    Scene scene = full_scene();
    scene.channels = {channel_of(1, AnimatedProperty::translation, Interpolation::linear, 2.0)};
    scene.channels[0].loop_s = 5.0;
    const auto path = test::test_folder() / "padded.glb";
    ASSERT_TRUE(save_glb(scene, path).ok());
    const auto again = load_gltf(path);
    ASSERT_TRUE(again.ok()) << again.error().message();
    ASSERT_EQ(again->channels.size(), 1u);
    EXPECT_EQ(again->channels[0].loop_s, 5.0);
    SceneState before{scene};
    SceneState after{*again};
    for (const double time_s : {0.25, 1.0, 3.0, 4.9, 5.1}) {
        before.set_time(time_s);
        after.set_time(time_s);
        EXPECT_EQ(before.world_from_node(1)[3], after.world_from_node(1)[3]) << time_s;
    }
}

TEST(GltfRoundTrip, SeveralMeshesAtOneNodeKeepTheirPlaces) {
    Scene scene = full_scene();
    scene.meshes.push_back(two_quads());
    scene.instances[1].mesh = 1;
    scene.instances[1].node = 0;
    const auto path = test::test_folder() / "several.glb";
    ASSERT_TRUE(save_glb(scene, path).ok());
    const auto again = load_gltf(path);
    ASSERT_TRUE(again.ok()) << again.error().message();
    EXPECT_EQ(again->triangle_count(), scene.triangle_count());
    ASSERT_EQ(again->instances.size(), scene.instances.size());
}

TEST(GltfRoundTrip, NothingIsWrittenIntoAMissingFolder) {
    const Status saved = save_glb(full_scene(), test::test_folder() / "missing" / "full.glb");
    ASSERT_FALSE(saved.ok());
    EXPECT_EQ(saved.error().message().find('\n'), std::string::npos);
}

TEST(DataGltfRoundTrip, RealModelsComeBack) {
    LW_NEED_SHARED_DATA();
    for (const char* name : {"gltf/Box/Box.glb", "gltf/christmas_challenge/christmas_challenge.gltf",
                             "gltf/Robot/robot.glb", "gltf/SimpleInstancing/simple-instancing.glb",
                             "gltf/office_diorama/office_diorama.glb", "gltf/Fox/Fox.glb"}) {
        SCOPED_TRACE(name);
        const auto scene = load_gltf(lw::test::shared_data_dir() / name);
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        const auto path = test::test_folder() / "again.glb";
        const Status saved = save_glb(*scene, path);
        ASSERT_TRUE(saved.ok()) << saved.error().message();
        const auto again = load_gltf(path);
        ASSERT_TRUE(again.ok()) << again.error().message();
        EXPECT_EQ(again->triangle_count(), scene->triangle_count());
        expect_same_materials(*scene, *again);
        expect_same_meshes(*scene, *again);
        EXPECT_EQ(again->nodes.size(), scene->nodes.size());
        EXPECT_EQ(again->movers.size(), scene->movers.size());
        expect_same_surroundings(*scene, *again);
    }
}

}  // namespace
}  // namespace lw::scene
