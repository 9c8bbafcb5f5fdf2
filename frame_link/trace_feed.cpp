#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"
#include "frame_link/trace.h"

namespace lw {

TraceFeed::TraceFeed(Trace trace, TimePoint start, double rate_hz)
    : trace_{std::move(trace)}, start_{start}, rate_hz_{rate_hz} {
    LW_CHECK(rate_hz > 0.0 && rate_hz <= 1e6, fmt::format("a tracker rate of {} Hz", rate_hz));
}

Duration TraceFeed::since_start(std::int64_t k) const { return from_seconds(static_cast<double>(k) / rate_hz_); }

std::size_t TraceFeed::newest(TimePoint now, std::span<PoseSample> samples) const {
    if (now < start_) return 0;
    // The quotient may round to either side of a sample's stamp, which decides.
    auto k = static_cast<std::int64_t>(std::floor(to_seconds(now - start_) * rate_hz_)) + 1;
    while (k > 0 && since_start(k) > now - start_) --k;

    const auto known = static_cast<std::size_t>(k + 1);
    const std::size_t filled = std::min(samples.size(), known);
    for (std::size_t i = 0; i < filled; ++i) {
        const std::int64_t number = k - static_cast<std::int64_t>(i);
        const TimePoint time = start_ + since_start(number);
        samples[i] = {time, pose_at(time), static_cast<std::uint64_t>(number) + 1};
    }
    return filled;
}

Pose TraceFeed::pose_at(TimePoint time) const { return trace_.at(to_seconds(time - start_)); }

}  // namespace lw
