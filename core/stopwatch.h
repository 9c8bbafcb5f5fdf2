#pragma once
/// Wall time and processor time, for cost figures and for sharing work among threads: nothing that a run shows depends
/// on them.

#include <chrono>
#include <ctime>

namespace lw {

class Stopwatch {
public:
    [[nodiscard]] double ms() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin_).count();
    }

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// What all threads of the program have worked since it was made: says the same on a machine that is busy with other
/// things.
class ProcessorStopwatch {
public:
    [[nodiscard]] double ms() const { return now_ms() - begin_ms_; }

private:
    [[nodiscard]] static double now_ms() {
        timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
    }

    double begin_ms_ = now_ms();
};

}  // namespace lw
