#pragma once
/// Independent pieces of work on several threads.

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace lw {

/// Calls work(i) for every i in [0, count), each once, on up to `threads` threads of which the caller is one; 0 means
/// as many as the machine has. Returns when all are done. `work` does not throw.
template <class Work>
void for_each_in_parallel(std::size_t count, int threads, Work work) {
    std::atomic<std::size_t> next{0};
    const auto take_turns = [&] {
        for (std::size_t i = next++; i < count; i = next++) work(i);
    };
    const int available = threads > 0 ? threads : static_cast<int>(std::thread::hardware_concurrency());
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(available, 1)));
    std::vector<std::thread> others;
    for (std::size_t i = 1; i < wanted; ++i) others.emplace_back(take_turns);
    take_turns();
    for (std::thread& thread : others) thread.join();
}

}  // namespace lw
