#include "apps/steal_watch.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

namespace lw {
namespace {

/// The eighth number of the first line of /proc/stat, in clock ticks (proc(5)).
std::optional<Duration> total_stolen() {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{std::fopen("/proc/stat", "r"), std::fclose};
    if (!file) return std::nullopt;
    long long ticks = 0;
    if (std::fscanf(file.get(), "cpu %*d %*d %*d %*d %*d %*d %*d %lld", &ticks) != 1) return std::nullopt;
    return from_seconds(static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK)));
}

}  // namespace

void StealWatch::sample(TimePoint now) {
    if (const auto stolen = total_stolen()) samples_.push_back({now, *stolen});
}

Duration StealWatch::stolen(TimePoint from, TimePoint to) const {
    if (samples_.empty()) return Duration::zero();
    const auto at = [](const Sample& sample, TimePoint time) { return sample.time < time; };
    auto first = std::lower_bound(samples_.begin(), samples_.end(), from, at);
    auto last = std::lower_bound(samples_.begin(), samples_.end(), to, at);
    if (first != samples_.begin()) --first;
    if (last == samples_.end()) --last;
    return std::max(last->stolen - first->stolen, Duration::zero());
}

}  // namespace lw
