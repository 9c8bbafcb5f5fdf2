#include "client_renderer/sorting_buffer.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "core/check.h"

namespace lw {

namespace {

/// A splitmix64 step: enough for a choice of slots, and the same everywhere.
std::uint64_t next_random(std::uint64_t& state) {
    std::uint64_t z = state += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
}

class Buffer {
public:
    Buffer(std::span<const std::uint32_t> states, SortingStrategy strategy, std::size_t capacity, std::uint64_t seed)
        : states_{states}, strategy_{strategy}, slots_(capacity), random_{seed} {
        const std::uint32_t most = states.empty() ? 0 : *std::ranges::max_element(states);
        newest_.assign(std::size_t{most} + 1, 0);
        waste_.assign(std::size_t{most} + 1, 0);
        order_.reserve(states.size());
    }

    std::vector<std::uint32_t> run() {
        for (std::uint32_t draw = 0; draw < states_.size(); ++draw) take(draw);
        while (waiting_ > 0) let_go(chosen());
        return std::move(order_);
    }

private:
    void take(std::uint32_t draw) {
        const std::uint32_t state = states_[draw];
        newest_[state] = ++clock_;
        if (strategy_ == SortingStrategy::none || current_ == state) {
            current_ = state;
            order_.push_back(draw);
            return;
        }
        while (waiting_ == slots_.size()) let_go(chosen());
        if (current_ == state) {  // it was this one that left
            order_.push_back(draw);
            return;
        }
        const auto slot = std::ranges::find_if(slots_, [](const auto& waiting) { return !waiting; });
        *slot = draw;
        ++waiting_;
    }

    /// The state that leaves.
    [[nodiscard]] std::uint32_t chosen() {
        if (strategy_ == SortingStrategy::random_choice) {
            std::size_t skip = next_random(random_) % waiting_;
            for (const auto& slot : slots_) {
                if (slot && skip-- == 0) return states_[*slot];
            }
        }
        if (strategy_ == SortingStrategy::round_robin) {
            while (!slots_[pointer_ % slots_.size()]) ++pointer_;
            return states_[*slots_[pointer_++ % slots_.size()]];
        }
        std::optional<std::uint32_t> best;
        for (const auto& slot : slots_) {
            if (!slot) continue;
            const std::uint32_t state = states_[*slot];
            const bool better = !best || (strategy_ == SortingStrategy::lru ? newest_[state] < newest_[*best]
                                                                            : waste_[state] > waste_[*best]);
            if (better) best = state;
        }
        return *best;
    }

    void let_go(std::uint32_t state) {
        for (const auto& slot : slots_) {
            if (slot) ++waste_[states_[*slot]];
        }
        waste_[state] = 0;
        current_ = state;
        // Within a state draws keep their order.
        const std::size_t first = order_.size();
        for (auto& slot : slots_) {
            if (!slot || states_[*slot] != state) continue;
            order_.push_back(*slot);
            slot.reset();
            --waiting_;
        }
        std::sort(order_.begin() + static_cast<std::ptrdiff_t>(first), order_.end());
    }

    std::span<const std::uint32_t> states_;
    SortingStrategy strategy_;
    std::vector<std::optional<std::uint32_t>> slots_;
    std::size_t waiting_ = 0;
    std::size_t pointer_ = 0;
    std::uint64_t clock_ = 0;
    std::uint64_t random_;
    std::optional<std::uint32_t> current_;
    std::vector<std::uint64_t> newest_;
    std::vector<std::uint64_t> waste_;
    std::vector<std::uint32_t> order_;
};

/// Every choice at every overflow, each filling of the buffer at each place once.
class Search {
public:
    Search(std::span<const std::uint32_t> states, std::size_t capacity) : states_{states}, capacity_{capacity} {
        const std::uint32_t most = states.empty() ? 0 : *std::ranges::max_element(states);
        empty_.assign(std::size_t{most} + 1, 0);
    }
    std::size_t run() { return fewest(0, empty_, std::nullopt); }

private:
    using Filling = std::vector<std::uint16_t>;  ///< waiting draws by state

    std::size_t fewest(std::size_t at, Filling filling, std::optional<std::uint32_t> current) {
        std::size_t waiting = 0;
        for (const std::uint16_t count : filling) waiting += count;
        while (at < states_.size() && (states_[at] == current || waiting < capacity_)) {
            if (states_[at] != current) {
                ++filling[states_[at]];
                ++waiting;
            }
            ++at;
        }
        if (waiting == 0) return 0;
        const auto key = std::make_pair(at, filling);
        if (const auto known = known_.find(key); known != known_.end()) return known->second;
        std::size_t best = std::numeric_limits<std::size_t>::max();
        for (std::uint32_t state = 0; state < filling.size(); ++state) {
            if (filling[state] == 0) continue;
            Filling left = filling;
            left[state] = 0;
            best = std::min(best, 1 + fewest(at, std::move(left), state));
        }
        known_.emplace(key, best);
        return best;
    }

    std::span<const std::uint32_t> states_;
    std::size_t capacity_;
    Filling empty_;
    std::map<std::pair<std::size_t, Filling>, std::size_t> known_;
};

}  // namespace

std::vector<std::uint32_t> sorted_through_buffer(std::span<const std::uint32_t> states, SortingStrategy strategy,
                                                 std::size_t capacity, std::uint64_t seed) {
    LW_CHECK(capacity >= 1, "a sorting buffer without room");
    return Buffer{states, strategy, capacity, seed}.run();
}

std::size_t state_changes(std::span<const std::uint32_t> states, std::span<const std::uint32_t> order) {
    std::size_t changes = 0;
    std::optional<std::uint32_t> current;
    for (const std::uint32_t draw : order) {
        if (current != states[draw]) ++changes;
        current = states[draw];
    }
    return changes;
}

std::size_t fewest_state_changes(std::span<const std::uint32_t> states, std::size_t capacity) {
    LW_CHECK(capacity >= 1, "a sorting buffer without room");
    return Search{states, capacity}.run();
}

}  // namespace lw
