#include "warp_server/band_pool.h"

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
    // On fewer cores than threads a worker may need this one's core: yield instead of spinning on.
    while (running_.load(std::memory_order_acquire) != 0) {
        if (!spin_until([&] { return running_.load(std::memory_order_acquire) == 0; })) std::this_thread::yield();
    }
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
        running_.fetch_sub(1, std::memory_order_release);
    }
}

RowRange band_of_rows(int rows, int index, int count) { return {rows * index / count, rows * (index + 1) / count}; }

}  // namespace lw
