// Every file of ../shared/data/gltf_bad loads or is refused with one line, quickly and within bounded memory.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "scene/gltf.h"
#include "tests/scene/resident_memory.h"
#include "tests/support/shared_data.h"

namespace lw::scene {
namespace {

namespace fs = std::filesystem;

struct IndexedFile {
    std::string path;
    bool valid = false;  // the validator found no error
};

std::vector<IndexedFile> indexed_files() {
    std::vector<IndexedFile> files;
    std::ifstream index{lw::test::shared_data_dir() / "gltf_bad" / "INDEX.tsv"};
    for (std::string line; std::getline(index, line);) {
        if (line.empty() || line[0] == '#' || line.rfind("path\t", 0) == 0) continue;
        std::istringstream cells{line};
        IndexedFile file;
        std::string errors;
        std::getline(cells, file.path, '\t');
        std::getline(cells, errors, '\t');
        file.valid = errors == "0";
        files.push_back(file);
    }
    return files;
}

// Valid, and refused all the same: they demand an extension or a version that we do not have, or draw from a buffer
// without data.
const std::set<std::string> kRightlyRefused = {
    "glTF-Validator/base/data/asset/min_version_valid.gltf",
    "glTF-Validator/base/data/root/named_objects.gltf",
    "glTF-Validator/base/data/root/unused_objects.gltf",
    "magnum-plugins/CgltfImporter/required-extensions-unsupported.gltf",
    "magnum-plugins/GltfImporter/required-extensions-unsupported.gltf",
    "magnum-plugins/GltfImporter/version-unsupported-min.gltf",
};

// Sanitizers slow the process down.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kMaxSeconds = 10.0;
#else
constexpr double kMaxSeconds = 2.0;
#endif

TEST(DataGltfBad, EveryFileLoadsOrIsRefusedWithOneLine) {
    LW_NEED_SHARED_DATA();
    const std::vector<IndexedFile> files = indexed_files();
    ASSERT_EQ(files.size(), 455u);
    for (const IndexedFile& file : files) {
        SCOPED_TRACE(file.path);
        const fs::path path = lw::test::shared_data_dir() / "gltf_bad" / file.path;
        ASSERT_TRUE(fs::exists(path));
        const auto start = std::chrono::steady_clock::now();
        const auto scene = load_gltf(path);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        // A bound against hanging, not a measurement.
        EXPECT_LT(seconds.count(), kMaxSeconds);
        if (scene.ok()) continue;
        const std::string message = scene.error().message();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_NE(message.find(path.filename().string()), std::string::npos) << message;
        EXPECT_FALSE(scene.error().what.empty());
        EXPECT_FALSE(scene.error().mend.empty());
        if (file.valid) {
            EXPECT_EQ(kRightlyRefused.count(file.path), 1u) << message;
        }
        if (std::getenv("LW_SHOW_REFUSALS") != nullptr) std::printf("%s\n", message.c_str());
    }
    EXPECT_LT(test::peak_resident_bytes(), test::kMaxResidentBytes);
}

}  // namespace
}  // namespace lw::scene
