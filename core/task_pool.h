#pragma once
/// A few threads that share the tasks of one stage of a frame, and wait for the next stage without sleeping in between.

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lw {

/// Calls one function for each of a few tasks, on several threads at once, over and over. Whoever is free takes the
/// next task, and only those that somebody took are waited for: a thread that the machine wakes late, or takes its
/// processor from, costs what it has begun and not a share of the whole. A stage lasts a millisecond, so threads spin
/// for a moment after each, to be there for the next, and sleep between frames.
/// One thread owns the pool and calls run(); it works too.
class TaskPool {
public:
    /// `task` in [0, tasks); `worker` in [0, threads()), 0 for the caller: no two tasks run on one worker at a time, so
    /// what needs memory of its own keeps one for each worker. Throws nothing.
    using Work = std::function<void(int task, int worker)>;

    /// @param threads    including the caller's, at least 1. The others inherit the scheduling of the constructing
    /// thread
    /// @param patience  how often they look for the next stage before they sleep, a look taking some 30 ns: for longer
    ///                  than the gap between two stages of a frame, far shorter than the gap between two frames
    explicit TaskPool(int threads, int patience = 400);
    ~TaskPool();
    TaskPool(const TaskPool&) = delete;
    TaskPool& operator=(const TaskPool&) = delete;

    [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

    /// Calls `work` once for every task, begun in ascending order (so the longest should come first), and returns when
    /// all are done. What the caller wrote before is seen by all; what they wrote is seen by the caller afterwards.
    /// One task is done by the caller without waking anybody. Allocates nothing. `tasks` >= 0.
    void run(int tasks, const Work& work);

    /// Wakes the others for a stage that begins soon: waking takes a twentieth of a millisecond and more.
    void rouse();

private:
    template <class Condition>
    [[nodiscard]] bool wait_awake(Condition done) const;
    void serve(int worker);
    void work_off(int worker);
    [[nodiscard]] bool take(int& task);

    int patience_;
    std::vector<std::thread> workers_;
    // Of the run under way. The first two change only while no task is left to be taken or done.
    const Work* work_ = nullptr;
    int tasks_ = 0;
    std::atomic<int> untaken_{0};
    std::atomic<int> undone_{0};
    std::atomic<bool> stop_{false};
    unsigned roused_ = 0;  // under the mutex
    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable done_;
};

/// Calls `work(begin, end)` for pieces of [0, size) of `piece` each, on `threads` or, without any, on the caller's.
/// Allocates nothing.
template <class OfRange>
void for_ranges(TaskPool* threads, std::size_t size, std::size_t piece, const OfRange& work) {
    if (threads == nullptr || threads->threads() == 1) {
        work(std::size_t{0}, size);
        return;
    }
    const auto of_task = [&](int task, int /*worker*/) {
        const std::size_t begin = static_cast<std::size_t>(task) * piece;
        work(begin, std::min(begin + piece, size));
    };
    threads->run(static_cast<int>((size + piece - 1) / piece), std::ref(of_task));
}

}  // namespace lw
