#pragma once
/// Runs the built program as a user would, and makes folders to run it in.

#include <filesystem>
#include <string>
#include <vector>

namespace lw::test {

struct ProgramRun {
    int exit_code = -1;  ///< 128 + number for a signal
    std::string out;
    std::string err;
};

/// Runs `latewarp ARGUMENTS` without a shell, waits for its end.
[[nodiscard]] ProgramRun run_latewarp(const std::vector<std::string>& arguments);

/// An empty folder for the running test, made anew on each call with the same name.
[[nodiscard]] std::filesystem::path fresh_folder(const std::string& name);

[[nodiscard]] std::string text_of(const std::filesystem::path& file);
void write_text_file(const std::filesystem::path& file, const std::string& text);

/// Every file below a folder by relative path, with its bytes.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> files_below(const std::filesystem::path& folder);

/// True for exactly one line "latewarp: error: WHAT: WHERE: MEND" and nothing else.
[[nodiscard]] bool is_one_error_line(const std::string& err);

}  // namespace lw::test
