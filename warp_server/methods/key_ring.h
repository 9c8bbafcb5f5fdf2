#pragma once
/// Where the points of `splat` compete for the pixels of the target.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <glm/vec2.hpp>
#include <vector>

#include "warp_server/methods/row_range.h"
#include "warp_server/methods/winner_rule.h"

namespace lw {

/// Keys of the target rows in flight, of some columns: row y lives in slot y modulo the number of slots, a power of
/// two. Few rows stay in the second-level cache, where a whole picture of 8 MB does not. All keys are 0 between display
/// frames.
class KeyRing {
public:
    /// Makes room for any part of a picture of this size. How many rows are in flight depends on how the head turns;
    /// told the size first, no later display frame pays for new memory, whose pages cost a millisecond for every two
    /// megabytes.
    void reserve(glm::ivec2 size_px) {
        const std::size_t count = static_cast<std::size_t>(stride_of(size_px.x)) * slots_of(size_px.y);
        if (keys_.size() < count) keys_.resize(count, WinnerKey{0});
    }

    /// Makes room for `rows` rows of the columns. Allocates only when it needs more than ever before.
    void reshape(RowRange columns, int rows) {
        first_column_ = columns.begin;
        width_ = columns.end - columns.begin;
        stride_ = stride_of(width_);
        slots_ = static_cast<int>(slots_of(rows));
        const std::size_t count = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(slots_);
        if (keys_.size() < count) keys_.resize(count, WinnerKey{0});
    }

    [[nodiscard]] int first_column() const { return first_column_; }
    [[nodiscard]] int width() const { return width_; }
    /// From a row to the next.
    [[nodiscard]] int stride() const { return stride_; }
    [[nodiscard]] int slots() const { return slots_; }
    [[nodiscard]] WinnerKey* data() { return keys_.data(); }
    /// Of the ring's first column.
    [[nodiscard]] WinnerKey* row(int y) {
        return keys_.data() + static_cast<std::size_t>(y & (slots_ - 1)) * static_cast<std::size_t>(stride_);
    }

private:
    // No power of two: a processor takes places that are whole pages apart for one when it orders reads and writes.
    static int stride_of(int width) { return (width + 63) / 64 * 64 + 8; }
    static unsigned slots_of(int rows) { return std::bit_ceil(static_cast<unsigned>(std::max(rows, 1))); }

    int first_column_ = 0;
    int width_ = 0;
    int stride_ = 0;
    int slots_ = 0;
    std::vector<WinnerKey> keys_;
};

}  // namespace lw
