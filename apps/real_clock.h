#pragma once
/// The machine's monotonic clock.

#include "core/clock.h"

namespace lw {

/// Zero is when it was made. Any thread.
class RealClock final : public Clock {
public:
    RealClock();
    [[nodiscard]] TimePoint now() const override;
    /// Sleeps in the kernel; a signal does not shorten it.
    void sleep_until(TimePoint wake) override;

private:
    Duration zero_{};  ///< CLOCK_MONOTONIC at the start
};

/// Processor time that the calling thread has used.
[[nodiscard]] Duration thread_cpu_time();

}  // namespace lw
