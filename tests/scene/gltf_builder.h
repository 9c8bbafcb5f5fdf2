#pragma once
/// Hand-made glTF files for tests.

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/gltf.h"

namespace lw::scene::test {

inline constexpr int kByte = 5120;
inline constexpr int kUnsignedByte = 5121;
inline constexpr int kShort = 5122;
inline constexpr int kUnsignedShort = 5123;
inline constexpr int kUnsignedInt = 5125;
inline constexpr int kFloat = 5126;

/// Folder for files of the running test; made anew for each test.
inline std::filesystem::path test_folder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const std::filesystem::path folder = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "scene" /
                                         (std::string{info->test_suite_name()} + "." + info->name());
    std::filesystem::create_directories(folder);
    return folder;
}

inline std::filesystem::path write_bytes(const std::string& name, std::span<const std::byte> bytes) {
    const std::filesystem::path path = test_folder() / name;
    std::ofstream file{path, std::ios::binary | std::ios::trunc};
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    return path;
}

inline std::filesystem::path write_text(const std::string& name, const std::string& text) {
    return write_bytes(name, std::as_bytes(std::span{text}));
}

/// A glTF file with one external buffer ("data.bin"); `root` may be changed at will before loading.
class GltfBuilder {
public:
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
    std::vector<std::byte> bytes;

    template <class T>
    int view(const std::vector<T>& elements) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        const auto raw = std::as_bytes(std::span{elements});
        root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", raw.size()}});
        bytes.insert(bytes.end(), raw.begin(), raw.end());
        return static_cast<int>(root["bufferViews"].size()) - 1;
    }

    int accessor(int view_index, int component_type, std::size_t count, const char* type) {
        root["accessors"].push_back(
            {{"bufferView", view_index}, {"componentType", component_type}, {"count", count}, {"type", type}});
        return static_cast<int>(root["accessors"].size()) - 1;
    }

    template <class T>
    int accessor(const std::vector<T>& elements, int component_type, std::size_t components) {
        static const char* const kTypes[] = {"", "SCALAR", "VEC2", "VEC3", "VEC4"};
        return accessor(view(elements), component_type, elements.size() / components, kTypes[components]);
    }

    /// One mesh of one primitive at one node.
    void draw(const nlohmann::json& primitive) {
        root["meshes"] = nlohmann::json::array({{{"primitives", nlohmann::json::array({primitive})}}});
        root["nodes"] = nlohmann::json::array({{{"mesh", 0}}});
        root["scenes"] = nlohmann::json::array({{{"nodes", nlohmann::json::array({0})}}});
    }

    /// A triangle (0,0,0) (1,0,0) (0,1,0) with a POSITION accessor of its own.
    void draw_triangle() {
        const int positions = accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0}, kFloat, 3);
        draw({{"attributes", {{"POSITION", positions}}}});
    }

    [[nodiscard]] std::filesystem::path write() {
        if (!bytes.empty()) {
            write_bytes("data.bin", bytes);
            root["buffers"] = nlohmann::json::array({{{"byteLength", bytes.size()}, {"uri", "data.bin"}}});
        }
        return write_text("model.gltf", root.dump());
    }

    [[nodiscard]] Result<Scene> load() { return load_gltf(write()); }
};

}  // namespace lw::scene::test
