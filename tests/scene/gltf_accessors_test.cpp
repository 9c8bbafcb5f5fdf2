// Accessor formats, by hand-made files: what the importer must read from each.

#include <gtest/gtest.h>

#include "tests/scene/gltf_builder.h"

namespace lw::scene {
namespace {

using nlohmann::json;
using test::GltfBuilder;

void expect_position(const Scene& scene, std::size_t vertex, glm::vec3 expected) {
    ASSERT_LT(vertex, scene.meshes.at(0).vertices.size());
    EXPECT_EQ(scene.meshes[0].vertices[vertex].position_object, expected);
}

TEST(GltfAccessors, ReadsFloatPositionsWithoutIndices) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->triangle_count(), 1u);
    expect_position(*scene, 1, {1, 0, 0});
    expect_position(*scene, 2, {0, 1, 0});
    // No normals in the file: the triangle's own.
    EXPECT_EQ(scene->meshes[0].vertices[0].normal_object, glm::vec3(0, 0, 1));
}

TEST(GltfAccessors, ReadsEveryQuantisedFormat) {
    struct Case {
        int component_type;
        bool normalized;
        float largest;  // what the stored 100 becomes
    };
    const std::vector<Case> cases = {
        {test::kByte, false, 100.0f},          {test::kByte, true, 100.0f / 127.0f},
        {test::kUnsignedByte, false, 100.0f},  {test::kUnsignedByte, true, 100.0f / 255.0f},
        {test::kShort, false, 100.0f},         {test::kShort, true, 100.0f / 32767.0f},
        {test::kUnsignedShort, false, 100.0f}, {test::kUnsignedShort, true, 100.0f / 65535.0f},
    };
    for (const Case& format : cases) {
        SCOPED_TRACE(format.component_type);
        const bool bytes = format.component_type == test::kByte || format.component_type == test::kUnsignedByte;
        GltfBuilder gltf;
        // Elements padded to 4 or 8 bytes, as the alignment rules of vertex attributes ask.
        const int view = bytes ? gltf.view(std::vector<std::uint8_t>{0, 0, 0, 9, 100, 0, 0, 9, 0, 100, 0, 9})
                               : gltf.view(std::vector<std::uint16_t>{0, 0, 0, 9, 100, 0, 0, 9, 0, 100, 0, 9});
        gltf.root["bufferViews"][0]["byteStride"] = bytes ? 4 : 8;
        const int positions = gltf.accessor(view, format.component_type, 3, "VEC3");
        if (format.normalized) gltf.root["accessors"][0]["normalized"] = true;
        gltf.draw({{"attributes", {{"POSITION", positions}}}});
        const auto scene = gltf.load();
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        expect_position(*scene, 1, {format.largest, 0, 0});
        expect_position(*scene, 2, {0, format.largest, 0});
    }
}

TEST(GltfAccessors, NormalisedSignedNumbersStopAtMinusOne) {
    GltfBuilder gltf;
    const int view = gltf.view(std::vector<std::int8_t>{-128, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0});
    gltf.root["bufferViews"][0]["byteStride"] = 4;
    gltf.draw({{"attributes", {{"POSITION", gltf.accessor(view, test::kByte, 3, "VEC3")}}}});
    gltf.root["accessors"][0]["normalized"] = true;
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    expect_position(*scene, 0, {-1, 0, 0});
    expect_position(*scene, 1, {1, 0, 0});
}

TEST(GltfAccessors, ReadsInterleavedViewsAtAnOffset) {
    GltfBuilder gltf;
    const int view = gltf.view(std::vector<float>{7, 0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0});
    gltf.root["bufferViews"][0]["byteStride"] = 16;
    const int positions = gltf.accessor(view, test::kFloat, 3, "VEC3");
    gltf.root["accessors"][0]["byteOffset"] = 4;
    gltf.draw({{"attributes", {{"POSITION", positions}}}});
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    expect_position(*scene, 1, {1, 0, 0});
    expect_position(*scene, 2, {0, 1, 0});
}

TEST(GltfAccessors, SparseElementsReplaceThoseOfTheView) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    const int indices = gltf.view(std::vector<std::uint16_t>{2});
    const int values = gltf.view(std::vector<float>{0, 5, 0});
    gltf.root["accessors"][0]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", indices}, {"componentType", test::kUnsignedShort}}},
        {"values", {{"bufferView", values}}}};
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    expect_position(*scene, 1, {1, 0, 0});
    expect_position(*scene, 2, {0, 5, 0});
}

TEST(GltfAccessors, WithoutAViewSparseElementsReplaceZeros) {
    GltfBuilder gltf;
    const int indices = gltf.view(std::vector<std::uint8_t>{1, 2});
    const int values = gltf.view(std::vector<float>{1, 0, 0, 0, 1, 0});
    gltf.root["accessors"].push_back({{"componentType", test::kFloat},
                                      {"count", 3},
                                      {"type", "VEC3"},
                                      {"sparse",
                                       {{"count", 2},
                                        {"indices", {{"bufferView", indices}, {"componentType", test::kUnsignedByte}}},
                                        {"values", {{"bufferView", values}}}}}});
    gltf.draw({{"attributes", {{"POSITION", 0}}}});
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    expect_position(*scene, 0, {0, 0, 0});
    expect_position(*scene, 2, {0, 1, 0});
}

TEST(GltfAccessors, ReadsIndicesOfEverySize) {
    const auto load_with = [](const auto& indices, int component_type) {
        GltfBuilder gltf;
        const int positions = gltf.accessor(std::vector<float>{9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 1, 0}, test::kFloat, 3);
        const int accessor = gltf.accessor(indices, component_type, 1);
        gltf.draw({{"attributes", {{"POSITION", positions}}}, {"indices", accessor}});
        return gltf.load();
    };
    const auto check = [](const Result<Scene>& scene) {
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        EXPECT_EQ(scene->triangle_count(), 1u);
        ASSERT_EQ(scene->meshes[0].vertices.size(), 3u);  // the unused vertex is dropped
        expect_position(*scene, 2, {0, 1, 0});
    };
    check(load_with(std::vector<std::uint8_t>{1, 2, 3}, test::kUnsignedByte));
    check(load_with(std::vector<std::uint16_t>{1, 2, 3}, test::kUnsignedShort));
    check(load_with(std::vector<std::uint32_t>{1, 2, 3}, test::kUnsignedInt));
}

TEST(GltfAccessors, ReadsColoursWithThreeAndFourComponents) {
    const auto first_colour = [](int accessor_components, const auto& colours, int component_type) {
        GltfBuilder gltf;
        gltf.draw_triangle();
        const int accessor = gltf.accessor(colours, component_type, static_cast<std::size_t>(accessor_components));
        gltf.root["accessors"][1]["normalized"] = component_type != test::kFloat;
        gltf.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = accessor;
        const auto scene = gltf.load();
        EXPECT_TRUE(scene.ok()) << scene.error().message();
        return scene.ok() ? scene->meshes[0].vertices[0].colour : Rgba8{};
    };
    EXPECT_EQ(first_colour(3, std::vector<float>{1, 0.5f, 0, 0, 0, 0, 0, 0, 0}, test::kFloat),
              (Rgba8{255, 128, 0, 255}));
    EXPECT_EQ(
        first_colour(4, std::vector<std::uint16_t>{65535, 0, 0, 32768, 0, 0, 0, 0, 0, 0, 0, 0}, test::kUnsignedShort),
        (Rgba8{255, 0, 0, 128}));
}

TEST(GltfAccessors, StripsAndFansKeepTheirWinding) {
    for (const int mode : {5, 6}) {
        SCOPED_TRACE(mode);
        GltfBuilder gltf;
        // A square that faces +Z: as a strip its corners zigzag, as a fan they go around.
        const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
        const std::vector<float> fan = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
        const int positions = gltf.accessor(mode == 5 ? strip : fan, test::kFloat, 3);
        gltf.draw({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
        const auto scene = gltf.load();
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        EXPECT_EQ(scene->triangle_count(), 2u);
        for (const Vertex& vertex : scene->meshes[0].vertices) EXPECT_EQ(vertex.normal_object, glm::vec3(0, 0, 1));
    }
}

TEST(GltfAccessors, PointsAndLinesAreLeftOutWithOneWarning) {
    GltfBuilder gltf;
    const int positions = gltf.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, test::kFloat, 3);
    json primitives = json::array();
    for (int mode = 0; mode <= 4; ++mode) {
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"mode", mode}});
    }
    gltf.draw(primitives[0]);
    gltf.root["meshes"][0]["primitives"] = primitives;
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->triangle_count(), 1u);
    EXPECT_EQ(scene->warnings, std::vector<std::string>{"4 point and line primitives are left out"});
}

TEST(GltfAccessors, BrokenNormalsAreComputedAnew) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    gltf.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        gltf.accessor(std::vector<float>{nan, 0, 0, 0, 0, 0, 0, 3, 0}, test::kFloat, 3);
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->meshes[0].vertices[0].normal_object, glm::vec3(0, 0, 1));
    EXPECT_EQ(scene->meshes[0].vertices[1].normal_object, glm::vec3(0, 0, 1));
    EXPECT_EQ(scene->meshes[0].vertices[2].normal_object, glm::vec3(0, 1, 0));  // too long, made a unit vector
    EXPECT_EQ(scene->warnings, std::vector<std::string>{"2 broken normals are computed anew"});
}

}  // namespace
}  // namespace lw::scene
