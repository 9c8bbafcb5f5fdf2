#include "warp_server/band_pool.h"

#include <algorithm>

#include "warp_server/methods/row_range.h"

namespace lw {
namespace {

// Some ten microseconds: longer than the gap between two stages of one display frame, far shorter than the gap between
// two display frames.
constexpr int kSpins = 4096;

// True once `done()`; false when it took too long.
template <class Condition>
bool spin_until(Condition done) {
    for (int i = 0; i < kSpins; ++i) {
        if (done()) return true;
    }
    return false;
}

}  // namespace

BandPool::BandPool(int threads) {
    for (int i = 1; i < threads; ++i) workers_.emplace_back([this, i] { serve(i); });
}

BandPool::~BandPool() {
    {
        const std::lock_guard lock{mutex_};
        stop_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
}

void BandPool::run(const std::function<void(int)>& work) {
    work_ = &work;
    running_.store(static_cast<int>(workers_.size()), std::memory_order_relaxed);
    {
        const std::lock_guard lock{mutex_};  // so that nobody falls asleep between its last look and the call below
        started_.fetch_add(1, std::memory_order_release);
    }
    wake_.notify_all();
    work(0);
    const auto is_done = [&] { return running_.load(std::memory_order_acquire) == 0; };
    if (spin_until(is_done)) return;
    // Sleep: on fewer cores than threads, or at a higher priority, spinning on would keep a worker from its core.
    std::unique_lock lock{mutex_};
    done_.wait(lock, is_done);
}

void BandPool::serve(int index) {
    unsigned seen = 0;
    while (true) {
        const auto has_news = [&] { return stop_ || started_.load(std::memory_order_acquire) != seen; };
        if (!spin_until(has_news)) {
            std::unique_lock lock{mutex_};
            wake_.wait(lock, has_news);
        }
        if (stop_) return;
        ++seen;
        (*work_)(index);
        if (running_.fetch_sub(1, std::memory_order_acq_rel) != 1) continue;
        { const std::lock_guard lock{mutex_}; }  // so that run() is either before its last look or asleep
        done_.notify_one();
    }
}

RowRange band_of_rows(int rows, int index, int count) { return {rows * index / count, rows * (index + 1) / count}; }

RowRange band_of_cost(std::span<const float> cost_until, int index, int count) {
    const int rows = static_cast<int>(cost_until.size()) - 1;
    const auto first_row_at = [&](int part) {
        if (part == 0) return 0;
        if (part == count) return rows;
        const float cost = cost_until.back() * static_cast<float>(part) / static_cast<float>(count);
        return static_cast<int>(std::lower_bound(cost_until.begin(), cost_until.end() - 1, cost) - cost_until.begin());
    };
    return {first_row_at(index), first_row_at(index + 1)};
}

}  // namespace lw
