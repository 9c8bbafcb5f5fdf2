#pragma once
/// Readers take paths: a folder of the process's own for the bytes of one run, gone at the end.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

namespace lw::test {

class ScratchFolder {
public:
    explicit ScratchFolder(const char* name)
        : path_{std::filesystem::temp_directory_path() /
                ("latewarp-fuzz-" + std::string{name} + "." + std::to_string(::getpid()))} {
        std::filesystem::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    void write(const char* name, std::span<const std::uint8_t> bytes) const {
        std::FILE* file = std::fopen((path_ / name).c_str(), "wb");
        if (file == nullptr) return;
        if (!bytes.empty()) (void)std::fwrite(bytes.data(), 1, bytes.size(), file);
        (void)std::fclose(file);
    }

private:
    std::filesystem::path path_;
};

}  // namespace lw::test
