// Bad files: one line that says what, where in which file, and the mend.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tests/scene/gltf_builder.h"

namespace lw::scene {
namespace {

using nlohmann::json;
using test::GltfBuilder;
using testing::EndsWith;
using testing::HasSubstr;

/// `where` ends with " at PLACE", or is the file alone.
void expect_refused(const Result<Scene>& scene, const std::string& what, const std::string& place) {
    ASSERT_FALSE(scene.ok());
    EXPECT_THAT(scene.error().what, HasSubstr(what));
    if (!place.empty()) {
        EXPECT_THAT(scene.error().where, EndsWith(" at " + place));
    }
    EXPECT_FALSE(scene.error().mend.empty());
    EXPECT_EQ(scene.error().message().find('\n'), std::string::npos);
}

/// A sound triangle, changed by `change`.
Result<Scene> load_changed(const std::function<void(GltfBuilder&)>& change) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    change(gltf);
    return gltf.load();
}

TEST(GltfRefusals, MissingFileDirectoryAndEmptyFile) {
    const auto missing = load_gltf(test::test_folder() / "nothing.glb");
    ASSERT_FALSE(missing.ok());
    EXPECT_THAT(missing.error().where, HasSubstr("nothing.glb"));
    const auto folder = load_gltf(test::test_folder());
    ASSERT_FALSE(folder.ok());
    expect_refused(load_gltf(test::write_text("empty.glb", "")), "empty", "");
    expect_refused(load_gltf(test::write_text("text.gltf", "hello")), "broken JSON", "");
    expect_refused(load_gltf(test::write_text("list.gltf", "[]")), "not an object", "");
}

TEST(GltfRefusals, FourGigabyteClaimsInATinyGlb) {
    const auto glb = [](std::uint32_t length, std::uint32_t chunk) {
        std::string bytes = "glTF";
        const auto append = [&bytes](std::uint32_t number) {
            for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(number >> shift & 0xFF));
        };
        append(2);
        append(length);
        append(chunk);
        bytes += "JSON";
        bytes += "{\"asset\":{\"version\":\"2.0\"}}  ";
        return bytes;
    };
    expect_refused(load_gltf(test::write_text("length.glb", glb(0xFFFFFFFF, 28))), "claims 4294967295 bytes", "");
    expect_refused(load_gltf(test::write_text("chunk.glb", glb(48, 0xFFFFFFFC))), "claims 4294967292 bytes", "");
    EXPECT_TRUE(load_gltf(test::write_text("sound.glb", glb(48, 28))).ok());
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["accessors"][0]["count"] = 4294967296.0; }),
                   "out of range", "accessors[0].count");
    expect_refused(load_changed([](GltfBuilder& gltf) {
                       gltf.root["accessors"][0]["count"] = 2000000000;
                       gltf.root["accessors"][0].erase("bufferView");
                   }),
                   "memory", "meshes[0].primitives[0]");
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["accessors"][0]["count"] = 4; }),
                   "reaches to byte 48", "accessors[0]");
}

TEST(GltfRefusals, IndicesOutOfRange) {
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["scene"] = 1; }), "index 1 is out of range", "scene");
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["nodes"][0]["mesh"] = 7; }), "index 7",
                   "nodes[0].mesh");
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["accessors"][0]["bufferView"] = -1; }),
                   "out of range", "accessors[0].bufferView");
    expect_refused(load_changed([](GltfBuilder& gltf) { gltf.root["bufferViews"][0]["byteLength"] = 4096; }),
                   "outside of buffer 0", "bufferViews[0]");
    expect_refused(load_changed([](GltfBuilder& gltf) {
                       gltf.root["meshes"][0]["primitives"][0]["indices"] =
                           gltf.accessor(std::vector<std::uint16_t>{0, 1, 3}, test::kUnsignedShort, 1);
                   }),
                   "vertex 3 does not exist", "meshes[0].primitives[0].indices");
}

TEST(GltfRefusals, PositionsThatAreNoNumbers) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfBuilder gltf;
        const int positions = gltf.accessor(std::vector<float>{0, 0, 0, bad, 0, 0, 0, 1, 0}, test::kFloat, 3);
        gltf.draw({{"attributes", {{"POSITION", positions}}}});
        expect_refused(gltf.load(), "position 1", "meshes[0].primitives[0].attributes.POSITION");
    }
}

TEST(GltfRefusals, NodesThatAreNoTree) {
    expect_refused(load_changed([](GltfBuilder& gltf) {
                       gltf.root["nodes"] = json::array({{{"children", {1}}}, {{"children", {0}}}});
                   }),
                   "own ancestor", "nodes[0]");
    expect_refused(load_changed([](GltfBuilder& gltf) {
                       gltf.root["nodes"] = json::array({{{"children", json::array({0})}}});
                   }),
                   "own ancestor", "nodes[0]");
    expect_refused(load_changed([](GltfBuilder& gltf) {
                       gltf.root["nodes"] = json::array(
                           {{{"children", json::array({2})}}, {{"children", json::array({2})}}, {{"mesh", 0}}});
                   }),
                   "two parents", "nodes[1].children");
}

TEST(GltfRefusals, DeepNestingIsNoStackOverflow) {
    const std::string deep(200000, '[');
    expect_refused(load_gltf(test::write_text("deep.gltf", "{\"extras\":" + deep)), "nested too deep", "");
    // A chain of nodes is no recursion either.
    GltfBuilder gltf;
    gltf.draw_triangle();
    constexpr int kNodes = 20000;
    for (int i = 1; i < kNodes; ++i) gltf.root["nodes"].push_back({{"children", json::array({i + 1})}});
    gltf.root["nodes"].push_back(json::object());
    gltf.root["nodes"][0]["children"] = json::array({1});
    const auto scene = gltf.load();
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->nodes.size(), static_cast<std::size_t>(kNodes) + 1);
}

TEST(GltfRefusals, UnknownRequiredExtensionByItsName) {
    expect_refused(
        load_changed([](GltfBuilder& gltf) { gltf.root["extensionsRequired"] = json::array({"ACME_shiny"}); }),
        "ACME_shiny", "extensionsRequired[0]");
    const auto used =
        load_changed([](GltfBuilder& gltf) { gltf.root["extensionsUsed"] = json::array({"ACME_shiny"}); });
    ASSERT_TRUE(used.ok());
    EXPECT_EQ(used->warnings, std::vector<std::string>{"extension ACME_shiny is ignored"});
}

TEST(GltfRefusals, FilesOutsideOfTheFolder) {
    test::write_text("secret.bin", std::string(36, '\0'));
    for (const char* uri : {"../secret.bin", "%2e%2e/secret.bin", "/etc/passwd", "file:///etc/passwd",
                            "http://example.org/data.bin", "a/../../secret.bin", "C:\\data.bin"}) {
        SCOPED_TRACE(uri);
        GltfBuilder gltf;
        gltf.draw_triangle();
        const std::filesystem::path path = gltf.write();
        gltf.root["buffers"][0]["uri"] = uri;
        expect_refused(load_gltf(test::write_text("escape.gltf", gltf.root.dump())), "not a file beside the model",
                       "buffers[0].uri");
    }
    GltfBuilder gltf;
    gltf.draw_triangle();
    const std::filesystem::path path = gltf.write();
    gltf.root["buffers"][0]["uri"] = "missing.bin";
    expect_refused(load_gltf(test::write_text("missing.gltf", gltf.root.dump())), "missing.bin\" is missing",
                   "buffers[0].uri");
}

TEST(GltfRefusals, AnImageThatClaimsToBeHugeIsRefusedUnread) {
    GltfBuilder gltf;
    gltf.draw_triangle();
    // A PNG header of 16384 x 16384 pixels and nothing else.
    const std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n', 0, 0, 0,
                                           13,   'I', 'H', 'D', 'R',  0,    0,    0x40, 0, 0, 0,
                                           0x40, 0,   8,   6,   0,    0,    0,    0,    0, 0, 0};
    gltf.root["images"] = json::array({{{"bufferView", gltf.view(png)}, {"mimeType", "image/png"}}});
    gltf.root["textures"] = json::array({{{"source", 0}}});
    gltf.root["materials"] = json::array({{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}});
    expect_refused(gltf.load(), "memory", "images[0]");
}

TEST(GltfRefusals, AnimationsOutOfOrder) {
    const auto load_times = [](const std::vector<float>& times) {
        return load_changed([&](GltfBuilder& gltf) {
            const int input = gltf.accessor(times, test::kFloat, 1);
            const int output = gltf.accessor(std::vector<float>(3 * times.size(), 1.0f), test::kFloat, 3);
            gltf.root["animations"] = json::array(
                {{{"channels", json::array({{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}})},
                  {"samplers", json::array({{{"input", input}, {"output", output}}})}}});
        });
    };
    EXPECT_TRUE(load_times({0, 1, 2}).ok());
    expect_refused(load_times({0, 2, 1}), "key 2 goes back in time", "animations[0].samplers[0].input");
    expect_refused(load_times({-1, 2}), "key 0 is at no time", "animations[0].samplers[0].input");
    expect_refused(load_times({0, std::numeric_limits<float>::quiet_NaN()}), "key 1 is at no time",
                   "animations[0].samplers[0].input");
}

}  // namespace
}  // namespace lw::scene
