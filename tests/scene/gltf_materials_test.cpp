// Materials, textures, lights and cameras as hand-made files state them.

#include <gtest/gtest.h>

#include <cmath>

#include "core/png_encoder.h"
#include "tests/scene/gltf_builder.h"

namespace lw::scene {
namespace {

using nlohmann::json;
using test::GltfBuilder;

/// A sound triangle with one material.
Result<Scene> load_material(const json& material) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    const std::vector<std::uint8_t> pixel = {10, 20, 30, 255};
    gltf.root["images"] = json::array(
        {{{"bufferView", gltf.view(encode_png({1, 1}, PngColour::rgba, 8, pixel))}, {"mimeType", "image/png"}}});
    gltf.root["samplers"] = json::array({{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}});
    gltf.root["textures"] = json::array({{{"source", 0}, {"sampler", 0}}});
    gltf.root["materials"] = json::array({material});
    gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
    return gltf.load();
}

TEST(GltfMaterials, DefaultsAreThoseOfTheStandard) {
    const auto scene = load_material(json::object());
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    const Material& material = scene->materials.at(0);
    EXPECT_EQ(material.base_colour, glm::vec4(1.0f));
    EXPECT_EQ(material.metallic, 1.0f);
    EXPECT_EQ(material.roughness, 1.0f);
    EXPECT_EQ(material.emissive, glm::vec3(0.0f));
    EXPECT_FALSE(material.alpha_cutoff.has_value());
    EXPECT_FALSE(material.double_sided);
    EXPECT_FALSE(material.unlit);
    EXPECT_EQ(material.base_colour_texture.image, kNone);
    EXPECT_TRUE(scene->images.empty());  // nobody uses it
}

TEST(GltfMaterials, MaskHasItsCutoffAndBlendIsAMaskWithOneWarning) {
    const auto mask = load_material({{"alphaMode", "MASK"}});
    ASSERT_TRUE(mask.ok());
    EXPECT_EQ(mask->materials[0].alpha_cutoff, 0.5f);
    EXPECT_TRUE(mask->warnings.empty());
    const auto blend = load_material({{"alphaMode", "BLEND"}});
    ASSERT_TRUE(blend.ok());
    EXPECT_TRUE(blend->materials[0].alpha_cutoff.has_value());
    EXPECT_EQ(blend->warnings, std::vector<std::string>{"blended materials are drawn as masks"});
}

TEST(GltfMaterials, TextureWrapFilterAndImageAreRead) {
    const auto scene = load_material({{"emissiveTexture", {{"index", 0}}}, {"emissiveFactor", {1, 0.5, 0}}});
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    const TextureUse& use = scene->materials[0].emissive_texture;
    ASSERT_EQ(use.image, 0);
    EXPECT_EQ(use.wrap_u, TextureWrap::clamp);
    EXPECT_EQ(use.wrap_v, TextureWrap::mirror);
    EXPECT_TRUE(use.nearest);
    EXPECT_EQ(scene->images.at(0).pixels.at(0, 0), (Rgba8{10, 20, 30, 255}));
    EXPECT_EQ(scene->materials[0].emissive, glm::vec3(1.0f, 0.5f, 0.0f));
}

TEST(GltfMaterials, TextureTransformOfTheStandardsExample) {
    // "Utilizes only the lower left quadrant of the source image, rotated clockwise 90 degrees."
    const auto scene = load_material(
        {{"emissiveTexture",
          {{"index", 0},
           {"extensions",
            {{"KHR_texture_transform", {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}}}}}}}});
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    const glm::mat3& transform = scene->materials[0].emissive_texture.uv_transform;
    const auto expect_uv = [&](glm::vec2 uv, glm::vec2 expected) {
        const glm::vec3 moved = transform * glm::vec3{uv, 1.0f};
        EXPECT_NEAR(moved.x, expected.x, 1e-6f);  // float sine and cosine of a quarter turn
        EXPECT_NEAR(moved.y, expected.y, 1e-6f);
    };
    expect_uv({0, 0}, {0, 1});
    expect_uv({1, 0}, {0, 0.5f});
    expect_uv({1, 1}, {0.5f, 0.5f});
}

TEST(GltfMaterials, UnlitAndEmissiveStrength) {
    const auto scene = load_material(
        {{"emissiveFactor", {1, 0.5, 0}},
         {"extensions",
          {{"KHR_materials_unlit", json::object()}, {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}});
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_TRUE(scene->materials[0].unlit);
    EXPECT_EQ(scene->materials[0].emissive, glm::vec3(4.0f, 2.0f, 0.0f));
}

TEST(GltfMaterials, ADamagedImageLeavesTheTextureOut) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    gltf.root["images"] =
        json::array({{{"bufferView", gltf.view(std::vector<std::uint8_t>(64, 7))}, {"mimeType", "image/webp"}}});
    gltf.root["textures"] = json::array({{{"source", 0}}});
    gltf.root["materials"] = json::array({{{"normalTexture", {{"index", 0}}}}});
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->materials[0].normal_texture.image, kNone);
    EXPECT_EQ(scene->warnings.size(), 1u);
}

TEST(GltfMaterials, TangentsAreMadeForNormalMaps) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    // u along +X, v along -Y: an upright picture.
    const int uv = gltf.accessor(std::vector<float>{0, 1, 1, 1, 0, 0}, test::kFloat, 2);
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = uv;
    gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
    const std::vector<std::uint8_t> pixel = {128, 128, 255, 255};
    gltf.root["images"] = json::array({{{"bufferView", gltf.view(encode_png({1, 1}, PngColour::rgba, 8, pixel))}}});
    gltf.root["textures"] = json::array({{{"source", 0}}});
    gltf.root["materials"] = json::array({{{"normalTexture", {{"index", 0}}}}});
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    // cross(normal, tangent) * w = +Y: up in the picture, where a normal map's green points.
    for (const Vertex& vertex : scene->meshes[0].vertices) EXPECT_EQ(vertex.tangent_object, glm::vec4(1, 0, 0, 1));
}

/// Nodes with lights and cameras below a node at (1, 2, 3) that is turned half around Y.
Result<Scene> load_with_attachments() {
    GltfBuilder gltf;
    gltf.draw_triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] =
        json::array({{{"type", "point"}, {"intensity", 8}, {"color", {1, 0.5, 0}}, {"range", 6}},
                     {{"type", "directional"}, {"intensity", 2}}});
    gltf.root["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}}});
    const auto light_node = [](int light) {
        return json{{"translation", {0, 0, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}};
    };
    gltf.root["nodes"] = json::array({{{"mesh", 0}},
                                      {{"translation", {1, 2, 3}}, {"rotation", {0, 1, 0, 0}}, {"children", {2, 3, 4}}},
                                      light_node(0),
                                      light_node(1),
                                      {{"camera", 0}, {"scale", {2, 2, 2}}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1};
    return gltf.load();
}

TEST(GltfLights, PointAndSunTakeTheirNodesPlace) {
    const auto scene = load_with_attachments();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    ASSERT_EQ(scene->point_lights.size(), 1u);
    EXPECT_LT(glm::length(scene->point_lights[0].position_world - glm::dvec3(1, 2, 2)), 1e-12);
    EXPECT_EQ(scene->point_lights[0].intensity, glm::vec3(8, 4, 0));
    EXPECT_EQ(scene->point_lights[0].range_m, 6.0f);
    // It shines along its node's -Z, which is the world's +Z here: the sun stands at -Z.
    EXPECT_LT(glm::length(scene->sun.direction_to_sun_world - glm::dvec3(0, 0, -1)), 1e-12);
    EXPECT_EQ(scene->sun.irradiance, glm::vec3(2.0f));
    EXPECT_EQ(scene->nodes.size(), 2u);  // lights and camera are no nodes of ours
}

TEST(GltfCameras, TheFirstCameraIsTheStartPose) {
    const auto scene = load_with_attachments();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    ASSERT_TRUE(scene->start_pose.has_value());
    EXPECT_LT(glm::length(scene->start_pose->position_m - glm::dvec3(1, 2, 3)), 1e-12);
    const glm::dvec3 forward = scene->start_pose->orientation * glm::dvec3{0, 0, -1};
    EXPECT_LT(glm::length(forward - glm::dvec3(0, 0, 1)), 1e-12);
}

}  // namespace
}  // namespace lw::scene
