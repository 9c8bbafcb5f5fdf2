#include "core/task_pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>

namespace lw::test {
namespace {

TEST(TaskPool, DoesEveryTaskOnceAndAgain) {
    for (const int threads : {1, 2, 5}) {
        TaskPool pool{threads};
        for (const int tasks : {0, 1, 2, 7}) {
            std::vector<std::atomic<int>> done(static_cast<std::size_t>(tasks));
            const TaskPool::Work work = [&](int task, int) { ++done[static_cast<std::size_t>(task)]; };
            for (int repeat = 1; repeat <= 200; ++repeat) {
                pool.run(tasks, work);
                for (const std::atomic<int>& count : done) ASSERT_EQ(count.load(), repeat);
            }
        }
    }
}

TEST(TaskPool, SharesRangesOutWhole) {
    TaskPool pool{3};
    for (TaskPool* threads : {static_cast<TaskPool*>(nullptr), &pool}) {
        for (const std::size_t size : {0U, 1U, 7U, 8U, 9U, 100U}) {
            std::vector<std::atomic<int>> done(size);
            for_ranges(threads, size, 8, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) ++done[i];
            });
            for (const std::atomic<int>& count : done) EXPECT_EQ(count.load(), 1);
        }
    }
}

TEST(TaskPool, NoWorkerHasTwoTasksAtATime) {
    constexpr int kThreads = 3;
    TaskPool pool{kThreads};
    std::array<std::atomic<int>, kThreads> busy{};
    std::atomic<bool> shared = false;
    const TaskPool::Work work = [&](int, int worker) {
        if (busy[static_cast<std::size_t>(worker)]++ != 0) shared = true;
        --busy[static_cast<std::size_t>(worker)];
    };
    for (int repeat = 0; repeat < 200; ++repeat) pool.run(16, work);
    EXPECT_FALSE(shared);
}

TEST(TaskPool, WhoeverIsFreeTakesWhatIsLeft) {
    TaskPool pool{2};
    // The first task ends when all others have: with shares given out beforehand its thread would wait for itself.
    std::latch others{5};
    const TaskPool::Work work = [&](int task, int) { task == 0 ? others.wait() : others.count_down(); };
    pool.run(6, work);
}

TEST(TaskPool, ShowsItsWorkToTheCallerAndTheCallersToIt) {
    TaskPool pool{3};
    std::vector<int> values(64, 0);
    const TaskPool::Work add_one = [&](int task, int) { ++values[static_cast<std::size_t>(task)]; };
    for (int repeat = 0; repeat < 500; ++repeat) {
        pool.run(64, add_one);
        for (int& value : values) {
            ASSERT_EQ(value, 2 * repeat + 1);
            ++value;
        }
    }
}

}  // namespace
}  // namespace lw::test
