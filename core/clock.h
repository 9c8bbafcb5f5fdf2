#pragma once
/// Time is an argument, or comes from a Clock; so every scheduler and predictor runs under a virtual one too.

#include <chrono>

namespace lw {

/// The one monotonic clock type. Its zero is arbitrary (the start of a run); the real clock lives in apps.
struct MonotonicTime {
    using rep = std::chrono::nanoseconds::rep;
    using period = std::chrono::nanoseconds::period;
    using duration = std::chrono::nanoseconds;
    using time_point = std::chrono::time_point<MonotonicTime>;
    static constexpr bool is_steady = true;
};
using TimePoint = MonotonicTime::time_point;
using Duration = MonotonicTime::duration;

[[nodiscard]] constexpr double to_seconds(Duration duration) { return std::chrono::duration<double>(duration).count(); }
[[nodiscard]] constexpr double to_ms(Duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
}
/// Rounded to the nearest nanosecond. |seconds| below 9e9.
[[nodiscard]] constexpr Duration from_seconds(double seconds) {
    return Duration{static_cast<Duration::rep>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5))};
}
[[nodiscard]] constexpr Duration from_ms(double ms) { return from_seconds(ms * 1e-3); }
/// Seconds since the clock's zero.
[[nodiscard]] constexpr double seconds_of(TimePoint time) { return to_seconds(time.time_since_epoch()); }
[[nodiscard]] constexpr TimePoint at_seconds(double seconds) { return TimePoint{from_seconds(seconds)}; }

/// Where a thread gets the time from, and how it waits. Any thread may call any function.
class Clock {
public:
    virtual ~Clock() = default;
    [[nodiscard]] virtual TimePoint now() const = 0;
    /// Returns at or after `wake`; at once when it has passed.
    virtual void sleep_until(TimePoint wake) = 0;
};

/// A clock that moves only when told to: waiting advances it. One thread.
class VirtualClock final : public Clock {
public:
    [[nodiscard]] TimePoint now() const override { return now_; }
    void sleep_until(TimePoint wake) override {
        if (wake > now_) now_ = wake;
    }
    void advance(Duration step) { now_ += step; }

private:
    TimePoint now_{};
};

}  // namespace lw
