#include "client_renderer/sorting_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace lw {
namespace {

constexpr SortingStrategy kStrategies[] = {SortingStrategy::none, SortingStrategy::lru, SortingStrategy::bounded_waste,
                                           SortingStrategy::random_choice, SortingStrategy::round_robin};

std::vector<std::uint32_t> random_states(std::mt19937& random, std::size_t count, std::uint32_t kinds) {
    std::uniform_int_distribution<std::uint32_t> kind{0, kinds - 1};
    std::vector<std::uint32_t> states(count);
    for (std::uint32_t& state : states) state = kind(random);
    return states;
}

TEST(SortingBuffer, EveryDrawLeavesOnceAndInOrderWithinItsState) {
    std::mt19937 random{1};
    const std::vector<std::uint32_t> states = random_states(random, 300, 7);
    for (const SortingStrategy strategy : kStrategies) {
        const std::vector<std::uint32_t> order = sorted_through_buffer(states, strategy, 9);
        std::vector<std::uint32_t> sorted = order;
        std::ranges::sort(sorted);
        std::vector<std::uint32_t> all(states.size());
        std::iota(all.begin(), all.end(), 0U);
        EXPECT_EQ(sorted, all);
        std::vector<std::uint32_t> last(7, 0);
        for (const std::uint32_t draw : order) {
            EXPECT_GE(draw, last[states[draw]]);
            last[states[draw]] = draw;
        }
    }
}

TEST(SortingBuffer, WithoutABufferNothingMoves) {
    const std::vector<std::uint32_t> states{2, 0, 2, 1, 1, 0};
    const std::vector<std::uint32_t> order = sorted_through_buffer(states, SortingStrategy::none, 4);
    EXPECT_TRUE(std::ranges::is_sorted(order));
    EXPECT_EQ(state_changes(states, order), 5U);
}

TEST(SortingBuffer, ABufferForAllSortsAll) {
    std::mt19937 random{2};
    const std::vector<std::uint32_t> states = random_states(random, 100, 6);
    for (const SortingStrategy strategy : kStrategies) {
        if (strategy == SortingStrategy::none) continue;
        EXPECT_EQ(state_changes(states, sorted_through_buffer(states, strategy, 100)), 6U);
    }
    EXPECT_EQ(fewest_state_changes(states, 100), 6U);
}

TEST(SortingBuffer, NoStrategyBeatsTheOneThatKnowsTheFuture) {
    std::mt19937 random{3};
    for (int round = 0; round < 10; ++round) {
        const std::vector<std::uint32_t> states = random_states(random, 40, 5);
        const std::size_t fewest = fewest_state_changes(states, 5);
        for (const SortingStrategy strategy : kStrategies) {
            EXPECT_GE(state_changes(states, sorted_through_buffer(states, strategy, 5)), fewest);
        }
    }
}

TEST(SortingBuffer, TheInputThatIsBadForLruIs) {
    // Page 48 with k = 17: m = 4 states that come once each keep pushing each other out; x and y come k times in a row.
    constexpr std::uint32_t kX = 4;
    constexpr std::uint32_t kY = 5;
    std::vector<std::uint32_t> states;
    for (int half = 0; half < 2; ++half) {
        for (const std::uint32_t long_state : {kX, kY}) {
            for (std::uint32_t c = 0; c < 4; ++c) states.push_back(c);
            states.insert(states.end(), 17, long_state);
        }
    }
    const std::size_t lru = state_changes(states, sorted_through_buffer(states, SortingStrategy::lru, 17));
    const std::size_t fewest = fewest_state_changes(states, 17);
    EXPECT_LE(fewest, 8U) << "the long states first, the others once at the end: 2 m";
    EXPECT_GT(lru, 2 * fewest);
}

}  // namespace
}  // namespace lw
