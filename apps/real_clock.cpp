#include "apps/real_clock.h"

#include <cerrno>
#include <ctime>

namespace lw {
namespace {

constexpr Duration::rep kNsPerSecond = 1'000'000'000;

Duration read(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return Duration{static_cast<Duration::rep>(time.tv_sec) * kNsPerSecond + time.tv_nsec};
}

}  // namespace

RealClock::RealClock() : zero_{read(CLOCK_MONOTONIC)} {}

TimePoint RealClock::now() const { return TimePoint{read(CLOCK_MONOTONIC) - zero_}; }

void RealClock::sleep_until(TimePoint wake) {
    const Duration::rep wake_ns = (wake.time_since_epoch() + zero_).count();
    const timespec time{static_cast<time_t>(wake_ns / kNsPerSecond), static_cast<long>(wake_ns % kNsPerSecond)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr) == EINTR) {
    }
}

Duration thread_cpu_time() { return read(CLOCK_THREAD_CPUTIME_ID); }

}  // namespace lw
