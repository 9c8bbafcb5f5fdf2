#pragma once
/// The best N by score: the queues of creations and updates (seed 000, sections 3.3 and 3.7).

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace lw {

/// Keeps the `capacity` elements of highest score; what falls out is handed back. Equal scores: the earlier one stays.
/// Keeps its memory. One thread at a time.
template <class T>
class BoundedQueue {
public:
    explicit BoundedQueue(std::size_t capacity) : capacity_{capacity} {}

    /// The element that does not fit: the new one, or one that it displaced.
    std::optional<T> push(double score, T element) {
        if (capacity_ == 0) return element;
        const Entry entry{score, count_++, std::move(element)};
        if (entries_.size() < capacity_) {
            entries_.push_back(entry);
            std::push_heap(entries_.begin(), entries_.end(), better);
            return std::nullopt;
        }
        if (!better(entry, entries_.front())) return entry.element;
        std::pop_heap(entries_.begin(), entries_.end(), better);
        std::optional<T> fallen{std::exchange(entries_.back(), entry).element};
        std::push_heap(entries_.begin(), entries_.end(), better);
        return fallen;
    }

    /// All elements, best first; the queue is empty afterwards.
    void drain(std::vector<T>& elements) {
        std::sort(entries_.begin(), entries_.end(), better);
        elements.clear();
        for (Entry& entry : entries_) elements.push_back(std::move(entry.element));
        entries_.clear();
        count_ = 0;
    }

private:
    struct Entry {
        double score;
        std::size_t order;
        T element;
    };
    static bool better(const Entry& a, const Entry& b) {
        return a.score != b.score ? a.score > b.score : a.order < b.order;
    }

    std::size_t capacity_;
    std::size_t count_ = 0;
    std::vector<Entry> entries_;  ///< a heap with the worst in front
};

}  // namespace lw
