#pragma once
/// How much of the machine's time somebody else took: on a virtual machine, its host.

#include <vector>

#include "core/clock.h"

namespace lw {

/// Reads the kernel's steal counter (/proc/stat) over a run. One thread writes, others read when it has ended.
class StealWatch {
public:
    /// Room for `reserved` samples before memory grows.
    explicit StealWatch(std::size_t reserved = 65536) { samples_.reserve(reserved); }

    /// To be called every few milliseconds. Does nothing where the kernel tells nothing.
    void sample(TimePoint now);

    /// Processor time that was stolen between the samples around [from, to], summed over processors. The kernel counts
    /// in steps of 10 ms.
    [[nodiscard]] Duration stolen(TimePoint from, TimePoint to) const;

private:
    struct Sample {
        TimePoint time;
        Duration stolen;  ///< since the machine started
    };
    std::vector<Sample> samples_;
};

}  // namespace lw
