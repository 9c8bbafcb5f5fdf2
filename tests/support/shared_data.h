#pragma once
/// Recorded data lies in the folder shared/data beside the project. Tests that use it are skipped without it, and fail
/// instead under CI=true or LW_REQUIRE_DATA=1: a test run that ran nothing is red.

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace lw::test {

inline std::filesystem::path shared_data_dir() {
    return std::filesystem::path{LW_SOURCE_DIR}.parent_path() / "shared" / "data";
}

inline bool shared_data_is_required() {
    const auto is_set = [](const char* name) {
        const char* value = std::getenv(name);
        return value != nullptr && *value != '\0' && std::string_view{value} != "0";
    };
    return is_set("CI") || is_set("LW_REQUIRE_DATA");
}

}  // namespace lw::test

/// First line of a test body that reads shared data.
#define LW_NEED_SHARED_DATA()                                                                   \
    do {                                                                                        \
        if (!std::filesystem::is_directory(::lw::test::shared_data_dir())) {                    \
            if (::lw::test::shared_data_is_required()) {                                        \
                FAIL() << "shared data is missing: " << ::lw::test::shared_data_dir().string(); \
            }                                                                                   \
            GTEST_SKIP() << "no shared data at " << ::lw::test::shared_data_dir().string();     \
        }                                                                                       \
    } while (false)
