#pragma once
/// The sorting buffer: a small buffer in front of the driver that puts draws of equal state together without knowing
/// what comes next (seed 004, pages 43-51).

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lw {

/// Which state leaves a full buffer.
enum class SortingStrategy : std::uint8_t {
    none,           ///< no buffer: draws go out as they come
    lru,            ///< the state whose newest draw came longest ago
    bounded_waste,  ///< the state that has taken most room over all changes of state so far
    random_choice,  ///< that of a draw picked at random
    round_robin,    ///< that of the draw in the next slot, in turn
};

/// The order in which draws leave: indices into `states`, each once. Lazy, as any strategy can be made: a draw of the
/// current state goes straight through, another one waits, and only a full buffer lets a state go, with all its draws.
/// @param capacity  draws the buffer holds, >= 1
/// @param seed      of the random choice
/// Pure, any thread.
[[nodiscard]] std::vector<std::uint32_t> sorted_through_buffer(std::span<const std::uint32_t> states,
                                                               SortingStrategy strategy, std::size_t capacity,
                                                               std::uint64_t seed = 1);

/// Changes of state along an order, the first state included. Pure, any thread.
[[nodiscard]] std::size_t state_changes(std::span<const std::uint32_t> states, std::span<const std::uint32_t> order);

/// The fewest changes that any strategy with such a buffer makes which knows the whole sequence, by trying every choice
/// at every overflow. For short sequences of few states: its time and memory grow with the number of fillings that a
/// buffer can have, about 10^5 of them per second. Pure, any thread.
[[nodiscard]] std::size_t fewest_state_changes(std::span<const std::uint32_t> states, std::size_t capacity);

}  // namespace lw
