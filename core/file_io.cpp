#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <memory>
#include <system_error>

#include "core/image_io.h"

namespace lw {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// Unique in this process and, with the process id, on this machine.
std::filesystem::path temporary_beside(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter{0};
    std::filesystem::path temporary = path;
    temporary += fmt::format(".{}-{}.tmp", ::getpid(), counter.fetch_add(1, std::memory_order_relaxed));
    return temporary;
}

std::string reason_of(int error) { return std::generic_category().message(error); }

}  // namespace

Status write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
    std::error_code ignored;
    if (path.empty() || std::filesystem::is_directory(path, ignored)) {
        return Error{"cannot write a file here", path.string(), "give the name of a file, not of a folder"};
    }
    const std::filesystem::path temporary = temporary_beside(path);
    File file{std::fopen(temporary.c_str(), "wbe")};
    if (!file) {
        return Error{fmt::format("cannot write ({})", reason_of(errno)), path.string(),
                     "name a folder that exists and can be written to"};
    }
    const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    const bool closed = std::fclose(file.release()) == 0;
    if (!written || !closed) {
        const std::string reason = reason_of(errno);
        std::filesystem::remove(temporary, ignored);
        return Error{fmt::format("cannot write all of it ({})", reason), path.string(), "make room on the disk"};
    }
    std::error_code rename_error;
    std::filesystem::rename(temporary, path, rename_error);
    if (rename_error) {
        std::filesystem::remove(temporary, ignored);
        return Error{fmt::format("cannot replace the file ({})", rename_error.message()), path.string(),
                     "remove what is there or choose another name"};
    }
    return Done{};
}

Result<std::vector<std::uint8_t>> read_file(const std::filesystem::path& path, std::uint64_t max_bytes) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found) {
        return Error{"no such file", path.string(), "check the name"};
    }
    if (!std::filesystem::is_regular_file(status)) {
        return Error{std::filesystem::is_directory(status) ? "is a folder" : "not a regular file", path.string(),
                     "give the name of a file"};
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) return Error{fmt::format("cannot read ({})", error.message()), path.string(), "check its permissions"};
    if (size > max_bytes) {
        return Error{fmt::format("{} bytes are more than the {} that are read", size, max_bytes), path.string(),
                     "give a smaller file"};
    }
    File file{std::fopen(path.c_str(), "rbe")};
    if (!file) {
        return Error{fmt::format("cannot read ({})", reason_of(errno)), path.string(), "check its permissions"};
    }
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    if (std::fread(bytes.data(), 1, bytes.size(), file.get()) != bytes.size()) {
        return Error{"the file ended while it was read", path.string(), "try again when nobody writes it"};
    }
    return bytes;
}

}  // namespace lw
