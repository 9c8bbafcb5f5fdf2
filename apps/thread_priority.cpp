#include "apps/thread_priority.h"

#include <pthread.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>

namespace lw {
namespace {

constexpr int kRealtimePriority = 10;
// Weight 110 against 1024: a stepped-back thread gets a tenth of a contested core.
constexpr int kStepBack = 10;

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

void wake_exactly() { prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL); }

void name_thread(const char* name) { pthread_setname_np(pthread_self(), name); }

std::string_view realtime_advice() {
    return "no real-time priority: allow it with 'ulimit -r 10' (rtprio in /etc/security/limits.conf)";
}

}  // namespace lw
