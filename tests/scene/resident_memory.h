#pragma once
/// The bound on memory that the readers of files promise.

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

namespace lw::scene::test {

/// Largest resident size of this process so far, bytes (Linux: /proc/self/status in kB).
inline std::uint64_t peak_resident_bytes() {
    std::ifstream status{"/proc/self/status"};
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
    }
    return 0;
}

// Sanitizers keep freed memory and shadow the rest.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr std::uint64_t kMaxResidentBytes = std::uint64_t{2} << 30;
#else
inline constexpr std::uint64_t kMaxResidentBytes = std::uint64_t{512} << 20;
#endif

}  // namespace lw::scene::test
