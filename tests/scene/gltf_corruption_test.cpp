// Damaged bytes in sound files: each variant loads or is refused; nothing else may happen. What goes wrong here shows
// as a crash, or as a report of the address sanitizer.

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/scene/gltf_builder.h"
#include "tests/scene/resident_memory.h"
#include "tests/support/shared_data.h"

namespace lw::scene {
namespace {

std::vector<char> bytes_of(const std::filesystem::path& path) {
    std::ifstream file{path, std::ios::binary};
    return {std::istreambuf_iterator<char>{file}, {}};
}

void load_bytes(const std::vector<char>& bytes) {
    const auto path = test::write_bytes("damaged.glb", std::as_bytes(std::span{bytes}));
    const auto scene = load_gltf(path);
    if (!scene.ok()) {
        EXPECT_EQ(scene.error().message().find('\n'), std::string::npos);
    }
}

/// Changes 1 to 4 bytes behind `first_byte`, `variants` times.
void damage(const std::filesystem::path& path, std::size_t first_byte, int variants) {
    const std::vector<char> sound = bytes_of(path);
    ASSERT_GT(sound.size(), first_byte);
    std::mt19937 random{1234};
    for (int variant = 0; variant < variants; ++variant) {
        std::vector<char> bytes = sound;
        for (std::uint32_t change = 0; change <= random() % 4; ++change) {
            bytes[first_byte + random() % (bytes.size() - first_byte)] = static_cast<char>(random() & 0xFF);
        }
        load_bytes(bytes);
    }
}

void cut_everywhere(const std::filesystem::path& path) {
    const std::vector<char> sound = bytes_of(path);
    const std::size_t step = sound.size() / 100 + 1;
    for (std::size_t size = 0; size < sound.size(); size += step) {
        load_bytes({sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size)});
    }
}

class DataGltfCorruption : public testing::TestWithParam<const char*> {};

TEST_P(DataGltfCorruption, ChangedBytesNeverCrash) {
    LW_NEED_SHARED_DATA();
    const auto path = lw::test::shared_data_dir() / "gltf" / GetParam();
    damage(path, 0, 60);
    // Most of a small file is JSON; these hit the geometry.
    damage(path, bytes_of(path).size() / 2, 60);
    EXPECT_LT(test::peak_resident_bytes(), test::kMaxResidentBytes);
}

TEST_P(DataGltfCorruption, CutFilesNeverCrash) {
    LW_NEED_SHARED_DATA();
    cut_everywhere(lw::test::shared_data_dir() / "gltf" / GetParam());
}

// The name begins with Data, so that the cases carry that label.
INSTANTIATE_TEST_SUITE_P(Data, DataGltfCorruption,
                         testing::Values("Box/Box.glb", "BoxVertexColors/BoxVertexColors.glb",
                                         "ext_required/BoxMeshopt.glb", "ext_required/DenseSphere.glb",
                                         "cesium_cubes/cubeStripIndexed.glb", "Fox/Fox.glb",
                                         "SimpleInstancing/simple-instancing.glb"));

}  // namespace
}  // namespace lw::scene
