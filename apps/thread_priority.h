#pragma once
/// Who goes first on the processor: the server's thread before the client and its GL threads.

#include <cstdint>
#include <string_view>

namespace lw {

/// What the machine allowed (`scheduling` in reports).
enum class Scheduling : std::uint8_t {
    fifo,  ///< the server's thread runs in real time
    nice,  ///< the client and its GL threads step back
    none,  ///< neither
};
[[nodiscard]] std::string_view name_of(Scheduling scheduling);

/// Gives the calling thread real-time priority (SCHED_FIFO 10: above every ordinary thread, below the kernel's own).
/// GL drivers start threads that inherit it: call it after contexts were made. LW_NO_REALTIME=1 in the environment acts
/// as a machine that refuses.
/// @return false without permission
[[nodiscard]] bool take_realtime_priority();

/// Lets the calling thread step back by 10 levels, and with it every thread that it starts from now on.
/// @return false when the machine refuses
[[nodiscard]] bool step_back();

/// Has the calling thread woken as exactly as its timers say, and before threads that are already running; ordinary
/// threads may otherwise be some milliseconds late. Does what the kernel allows.
void wake_exactly();

/// Names the calling thread in debuggers and profilers. At most 15 characters.
void name_thread(const char* name);

/// One line that says how to get real-time priority.
[[nodiscard]] std::string_view realtime_advice();

}  // namespace lw
