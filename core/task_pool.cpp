#include "core/task_pool.h"

namespace lw {
namespace {

void be_idle_for_a_moment() {
#if defined(__x86_64__)
    __builtin_ia32_pause();  // the other thread of the core goes on
#endif
}

}  // namespace

TaskPool::TaskPool(int threads, int patience) : patience_{patience} {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this, i] { serve(i); });
}

TaskPool::~TaskPool() {
    {
        const std::lock_guard lock{mutex_};
        stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

void TaskPool::run(int tasks, const Work& work) {
    if (workers_.empty() || tasks <= 1) {
        for (int task = 0; task < tasks; ++task) work(task, 0);
        return;
    }
    work_ = &work;
    tasks_ = tasks;
    undone_.store(tasks, std::memory_order_relaxed);
    {
        const std::lock_guard lock{mutex_};  // so that nobody falls asleep between its last look and the call below
        untaken_.store(tasks, std::memory_order_release);
    }
    wake_.notify_all();
    work_off(0);
    const auto is_done = [&] { return undone_.load(std::memory_order_acquire) == 0; };
    if (wait_awake(is_done)) return;
    // Sleep: on fewer cores than threads, or at a higher priority, spinning on would keep a worker from its core.
    std::unique_lock lock{mutex_};
    done_.wait(lock, is_done);
}

void TaskPool::rouse() {
    {
        const std::lock_guard lock{mutex_};
        ++roused_;
    }
    wake_.notify_all();
}

// True once `done()`; false when it took too long.
template <class Condition>
bool TaskPool::wait_awake(Condition done) const {
    for (int i = 0; i < patience_; ++i) {
        if (done()) return true;
        be_idle_for_a_moment();
    }
    return false;
}

// Counts down, so that a worker that comes late, even in the next run, finds either a task of the run under way or
// none, and needs to know nothing of the run to tell.
bool TaskPool::take(int& task) {
    int untaken = untaken_.load(std::memory_order_relaxed);
    do {
        if (untaken == 0) return false;
    } while (!untaken_.compare_exchange_weak(untaken, untaken - 1, std::memory_order_acquire));
    task = tasks_ - untaken;
    return true;
}

void TaskPool::work_off(int worker) {
    int task = 0;
    while (take(task)) {
        (*work_)(task, worker);
        if (undone_.fetch_sub(1, std::memory_order_acq_rel) != 1 || worker == 0) continue;
        { const std::lock_guard lock{mutex_}; }  // so that run() is either before its last look or asleep
        done_.notify_one();
    }
}

void TaskPool::serve(int worker) {
    const auto has_tasks = [&] { return stop_ || untaken_.load(std::memory_order_relaxed) > 0; };
    unsigned roused = 0;
    while (true) {
        if (!wait_awake(has_tasks)) {
            std::unique_lock lock{mutex_};
            wake_.wait(lock, [&] { return has_tasks() || roused_ != roused; });
            roused = roused_;
        }
        if (stop_) return;
        work_off(worker);
    }
}

}  // namespace lw
