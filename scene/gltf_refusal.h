#pragma once
/// How the glTF reader gives up, and what keeps its memory bounded. Private to the reader.

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <utility>

#include "core/result.h"

namespace lw::scene {

/// Thrown by any depth of the reader; load_gltf() catches it and adds the file's name. It never leaves that function.
struct GltfRefusal {
    std::string what;   ///< "index out of range"
    std::string place;  ///< in the JSON: "accessors[3].bufferView"; empty: the file as a whole
    std::string mend = "export the model again, or check it with a glTF validator";
};

[[noreturn]] inline void refuse(std::string what, std::string place) {
    throw GltfRefusal{std::move(what), std::move(place)};
}
[[noreturn]] inline void refuse(std::string what, std::string place, std::string mend) {
    throw GltfRefusal{std::move(what), std::move(place), std::move(mend)};
}

/// Bytes the reader holds or is about to hold: file, JSON, decoded buffers and images, vertices. Everything whose size
/// a file can choose is charged before it is allocated, so that no claim in a file makes us allocate wildly.
class MemoryBudget {
public:
    /// Below the 512 MB that a load may reach: allocators round up, and libraries keep some memory of their own.
    static constexpr std::uint64_t kLimitBytes = std::uint64_t{448} << 20;

    /// Charges `bytes`; refuses the file when the sum passes the limit. `place` names what is being read.
    void charge(std::uint64_t bytes, const std::string& place) {
        if (bytes > kLimitBytes - charged_bytes_) {
            refuse(fmt::format("needs more than {} MB of memory", kLimitBytes >> 20), place,
                   "reduce the model or split it into several files");
        }
        charged_bytes_ += bytes;
    }
    /// As charge() for `count` things of `size` bytes; the product may not fit 64 bits.
    void charge(std::uint64_t count, std::uint64_t size, const std::string& place) {
        charge(size != 0 && count > kLimitBytes / size ? kLimitBytes + 1 : count * size, place);
    }
    void release(std::uint64_t bytes) { charged_bytes_ -= bytes; }

    [[nodiscard]] std::uint64_t charged_bytes() const { return charged_bytes_; }
    [[nodiscard]] std::uint64_t left_bytes() const { return kLimitBytes - charged_bytes_; }

private:
    std::uint64_t charged_bytes_ = 0;
};

/// A charge for memory that lives as long as a scope.
class TemporaryCharge {
public:
    TemporaryCharge(MemoryBudget& budget, std::uint64_t count, std::uint64_t size, const std::string& place)
        : budget_{budget}, start_bytes_{budget.charged_bytes()} {
        budget_.charge(count, size, place);
        bytes_ = budget_.charged_bytes() - start_bytes_;
    }
    TemporaryCharge(const TemporaryCharge&) = delete;
    TemporaryCharge& operator=(const TemporaryCharge&) = delete;
    ~TemporaryCharge() { budget_.release(bytes_); }

private:
    MemoryBudget& budget_;
    std::uint64_t start_bytes_;
    std::uint64_t bytes_ = 0;
};

}  // namespace lw::scene
