#include "tests/apps/program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>

extern char** environ;

namespace lw::test {

ProgramRun run_latewarp(const std::vector<std::string>& arguments) {
    const std::filesystem::path folder = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "apps" / "streams";
    std::filesystem::create_directories(folder);
    const std::filesystem::path out = folder / (std::to_string(getpid()) + ".out");
    const std::filesystem::path err = folder / (std::to_string(getpid()) + ".err");

    std::vector<std::string> words = {LW_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), kFlags, 0644);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), kFlags, 0644);
    pid_t child = 0;
    const int trouble = posix_spawn(&child, LW_PROGRAM, &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ProgramRun run;
    int status = 0;
    if (trouble == 0 && waitpid(child, &status, 0) == child) {
        run.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    run.out = text_of(out);
    run.err = text_of(err);
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return run;
}

std::filesystem::path fresh_folder(const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "apps" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

std::string text_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream{file, std::ios::binary}.rdbuf();
    return text.str();
}

void write_text_file(const std::filesystem::path& file, const std::string& text) {
    std::ofstream{file, std::ios::binary} << text;
}

std::vector<std::pair<std::string, std::string>> files_below(const std::filesystem::path& folder) {
    std::vector<std::pair<std::string, std::string>> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
        if (!entry.is_regular_file()) continue;
        files.emplace_back(std::filesystem::relative(entry.path(), folder).string(), text_of(entry.path()));
    }
    std::sort(files.begin(), files.end());
    return files;
}

bool is_one_error_line(const std::string& err) {
    static const std::regex kForm{"latewarp: error: [^\n]+: [^\n]+: [^\n]+\n"};
    return std::regex_match(err, kForm);
}

}  // namespace lw::test
