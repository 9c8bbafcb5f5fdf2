#pragma once
/// A folder of a test's own, empty at first and gone afterwards.

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace lw::test {

class TemporaryFolder {
public:
    TemporaryFolder() {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        path_ = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "frame_link" /
                (std::string{test->test_suite_name()} + "." + test->name() + "." + std::to_string(::getpid()));
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Writes a file, folders in its name included, and returns its path.
    [[nodiscard]] std::string file(const std::string& name, std::string_view bytes) const {
        const std::filesystem::path target = path_ / name;
        std::filesystem::create_directories(target.parent_path());
        std::ofstream{target, std::ios::binary}.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        return target.string();
    }

private:
    std::filesystem::path path_;
};

}  // namespace lw::test
