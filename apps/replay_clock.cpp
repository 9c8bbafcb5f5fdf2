#include "apps/replay_clock.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {

TimePoint ReplayClock::middle_of_life(std::uint64_t frame) const {
    const Duration app_period = from_seconds(1.0 / timing_.app_hz);
    const Duration display_period = from_seconds(1.0 / timing_.display_hz);
    return published(frame) + app_period / 2 + timing_.lead + display_period / 2;
}

TimePoint ReplayClock::end_of_life(std::uint64_t frame) const {
    return middle_of_life(frame) + from_seconds(0.5 / timing_.app_hz);
}

Refresh ReplayClock::refresh(std::uint64_t number) const {
    return {number, at_seconds(static_cast<double>(number) / timing_.display_hz),
            from_seconds(1.0 / timing_.display_hz)};
}

std::uint64_t ReplayClock::first_refresh() const {
    const TimePoint ready = published(kFirstShownFrame);
    const double earliest_s = seconds_of(ready + timing_.lead);
    // One below the estimate, since that may be a rounding error too late.
    auto number = static_cast<std::uint64_t>(std::max(0.0, std::floor(earliest_s * timing_.display_hz) - 1.0));
    while (latched(number) < ready) ++number;
    return number;
}

std::uint64_t ReplayClock::frame_shown_at(std::uint64_t number) const {
    const TimePoint latch = latched(number);
    LW_CHECK(latch >= published(0), "a refresh before the first frame");
    const double since_s = to_seconds(latch - published(0));
    auto frame = static_cast<std::uint64_t>(std::max(0.0, std::floor(since_s * timing_.app_hz) - 1.0));
    while (published(frame + 1) <= latch) ++frame;
    return frame;
}

}  // namespace lw
