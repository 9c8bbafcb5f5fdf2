// Real models in ../shared/data/gltf against the triangle counts of its SOURCES.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "scene/gltf.h"
#include "tests/support/shared_data.h"

namespace lw::scene {
namespace {

namespace fs = std::filesystem;

struct ExpectedModel {
    std::string path;  // relative to the data folder
    std::uint64_t triangles = 0;
};

/// Rows "| gltf/NAME/FILE | 94722 (94722) | ..." of the table of models.
std::vector<ExpectedModel> models_of_table() {
    std::vector<ExpectedModel> models;
    std::ifstream table{lw::test::shared_data_dir() / "SOURCES.md"};
    for (std::string line; std::getline(table, line);) {
        if (line.rfind("| gltf/", 0) != 0) continue;
        std::istringstream cells{line.substr(2)};
        ExpectedModel model;
        std::string bar;
        std::string unique;
        cells >> model.path >> bar >> model.triangles >> unique;
        const bool is_model = model.path.find(".gl") != std::string::npos && !unique.empty() && unique.front() == '(';
        if (is_model) models.push_back(model);
    }
    return models;
}

/// The table counts a mesh once per node, also where EXT_mesh_gpu_instancing repeats it.
std::uint64_t triangles_of_nodes(const Scene& scene) {
    std::set<std::pair<int, int>> counted;
    std::uint64_t triangles = 0;
    for (const Instance& instance : scene.instances) {
        if (!counted.emplace(instance.node, instance.mesh).second) continue;
        for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(instance.mesh)].primitives) {
            triangles += primitive.index_count / 3;
        }
    }
    return triangles;
}

void expect_sound(const Scene& scene) {
    for (const Mesh& mesh : scene.meshes) {
        const auto bad_index = [&mesh](std::uint32_t index) { return index >= mesh.vertices.size(); };
        EXPECT_TRUE(std::none_of(mesh.indices.begin(), mesh.indices.end(), bad_index));
        for (const Vertex& vertex : mesh.vertices) {
            // Normalised in float: a few units in the last place.
            ASSERT_NEAR(glm::length(vertex.normal_object), 1.0f, 1e-5f);
            ASSERT_NEAR(glm::length(glm::vec3{vertex.tangent_object}), 1.0f, 1e-5f);
        }
        for (const Primitive& primitive : mesh.primitives) {
            EXPECT_EQ(primitive.index_count % 3, 0u);
            EXPECT_LE(std::uint64_t{primitive.first_index} + primitive.index_count, mesh.indices.size());
            EXPECT_LT(primitive.material, static_cast<int>(scene.materials.size()));
        }
    }
    ASSERT_TRUE(scene.start_pose.has_value());
}

TEST(DataGltf, EveryModelOfTheTableHasItsTriangles) {
    LW_NEED_SHARED_DATA();
    const std::vector<ExpectedModel> models = models_of_table();
    ASSERT_EQ(models.size(), 54u);
    for (const ExpectedModel& model : models) {
        SCOPED_TRACE(model.path);
        const auto scene = load_gltf(lw::test::shared_data_dir() / model.path);
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        EXPECT_EQ(triangles_of_nodes(*scene), model.triangles);
        expect_sound(*scene);
    }
}

TEST(DataGltf, GpuInstancingRepeatsTheMesh) {
    LW_NEED_SHARED_DATA();
    const auto scene = load_gltf(lw::test::shared_data_dir() / "gltf/SimpleInstancing/simple-instancing.glb");
    ASSERT_TRUE(scene.ok()) << scene.error().message();
    EXPECT_EQ(scene->instances.size(), 125u);  // 5 x 5 x 5 cubes
    EXPECT_EQ(scene->triangle_count(), 125u * 12u);
}

/// Sum over all .gltf files of a folder and its folders.
void expect_kit(const std::string& folder, std::size_t expected_files, std::uint64_t expected_triangles) {
    std::size_t files = 0;
    std::uint64_t triangles = 0;
    for (const auto& entry : fs::recursive_directory_iterator{lw::test::shared_data_dir() / "gltf" / folder}) {
        if (entry.path().extension() != ".gltf") continue;
        SCOPED_TRACE(entry.path().string());
        const auto scene = load_gltf(entry.path());
        ASSERT_TRUE(scene.ok()) << scene.error().message();
        expect_sound(*scene);
        ++files;
        triangles += scene->triangle_count();
    }
    EXPECT_EQ(files, expected_files);
    EXPECT_EQ(triangles, expected_triangles);
}

TEST(DataGltf, CityKitHasItsTriangles) {
    LW_NEED_SHARED_DATA();
    expect_kit("kaykit_city", 41, 26813);
}

TEST(DataGltf, MedievalKitHasItsTriangles) {
    LW_NEED_SHARED_DATA();
    expect_kit("kaykit_medieval", 81, 71163);
}

}  // namespace
}  // namespace lw::scene
