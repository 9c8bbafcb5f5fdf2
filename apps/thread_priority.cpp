#include "apps/thread_priority.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

namespace lw {
namespace {

constexpr int kRealtimePriority = 10;
// Weight 110 against 1024: a stepped-back thread gets a tenth of a contested core.
constexpr int kStepBack = 10;

constexpr std::uint64_t kShortSlice_ns = 100'000;  // the shortest there is

// struct sched_attr of the kernel; its header clashes with the C library's.
struct SchedulingAttributes {
    std::uint32_t size = sizeof(SchedulingAttributes);
    std::uint32_t policy = SCHED_OTHER;
    std::uint64_t flags = 0;
    std::int32_t nice = 0;
    std::uint32_t priority = 0;
    std::uint64_t runtime_ns = 0;
    std::uint64_t deadline_ns = 0;
    std::uint64_t period_ns = 0;
};
static_assert(sizeof(SchedulingAttributes) == 48);

bool is_realtime_forbidden() {
    const char* value = std::getenv("LW_NO_REALTIME");
    return value != nullptr && std::string_view{value} == "1";
}

}  // namespace

std::string_view name_of(Scheduling scheduling) {
    switch (scheduling) {
        case Scheduling::fifo:
            return "fifo";
        case Scheduling::nice:
            return "nice";
        case Scheduling::none:
            break;
    }
    return "none";
}

bool take_realtime_priority() {
    if (is_realtime_forbidden()) return false;
    sched_param parameters{};
    parameters.sched_priority = kRealtimePriority;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

bool step_back() {
    const auto self = static_cast<id_t>(gettid());
    return setpriority(PRIO_PROCESS, self, getpriority(PRIO_PROCESS, self) + kStepBack) == 0;
}

void wake_exactly() {
    prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
    if (sched_getscheduler(0) != SCHED_OTHER) return;
    // Linux 6.12 and later: a thread that asks for short slices is given the processor at once when it wakes, instead
    // of when the running one has used up its own, up to 3 ms later. Older kernels take no notice.
    SchedulingAttributes attributes;
    attributes.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(gettid()));
    attributes.runtime_ns = kShortSlice_ns;
    syscall(SYS_sched_setattr, 0, &attributes, 0U);
}

void name_thread(const char* name) { pthread_setname_np(pthread_self(), name); }

std::string_view realtime_advice() {
    return "no real-time priority: allow it with 'ulimit -r 10' (rtprio in /etc/security/limits.conf)";
}

}  // namespace lw
