#pragma once
/// A few threads that wait for the next stage of a display frame without sleeping in between.

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace lw {

/// Runs one function on several threads at once, over and over. A stage of a display frame lasts a millisecond, so the
/// workers spin for a moment after each run, to be there for the next stage, and sleep between display frames.
/// One thread owns the pool and calls run(); it works too.
class BandPool {
public:
    /// @param threads  including the caller's, at least 1
    explicit BandPool(int threads);
    ~BandPool();
    BandPool(const BandPool&) = delete;
    BandPool& operator=(const BandPool&) = delete;

    [[nodiscard]] int threads() const { return static_cast<int>(workers_.size()) + 1; }

    /// Calls `work(i)` once for every i in [0, threads()), each on a thread of its own, and returns when all are done.
    /// What the caller wrote before is seen by all; what they wrote is seen by the caller afterwards. `work` throws
    /// nothing. Allocates nothing.
    void run(const std::function<void(int)>& work);

private:
    void serve(int index);

    std::vector<std::thread> workers_;
    const std::function<void(int)>* work_ = nullptr;
    std::atomic<unsigned> started_{0};  // number of runs begun
    std::atomic<int> running_{0};       // workers still busy with the newest run
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::condition_variable wake_;
    std::condition_variable done_;
};

/// Cuts `rows` rows into bands for `count` threads: band `index` of them, as equal as they can be.
struct RowRange;
[[nodiscard]] RowRange band_of_rows(int rows, int index, int count);

/// Bands of rows that cost about the same: `cost_until[y]` is the cost of all rows before y, one more entry than rows,
/// ascending. Band `index` of `count`.
[[nodiscard]] RowRange band_of_cost(std::span<const float> cost_until, int index, int count);

}  // namespace lw
