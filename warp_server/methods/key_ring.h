#pragma once
/// Where the points of `splat` compete for the pixels of the target.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <vector>

#include "warp_server/methods/winner_rule.h"

namespace lw {

/// Keys of the target rows in flight: row y lives in slot y modulo the number of slots, a power of two. Few rows stay
/// in the second-level cache, where a whole picture of 8 MB does not. All keys are 0 between display frames.
class KeyRing {
public:
    /// Makes room for `rows` rows of `width` keys. Allocates only when it needs more than ever before.
    void reshape(int width, int rows) {
        width_ = width;
        slots_ = static_cast<int>(std::bit_ceil(static_cast<unsigned>(std::max(rows, 1))));
        const std::size_t count = static_cast<std::size_t>(width_) * static_cast<std::size_t>(slots_);
        if (keys_.size() < count) keys_.resize(count, WinnerKey{0});
    }

    [[nodiscard]] int width() const { return width_; }
    [[nodiscard]] int slots() const { return slots_; }
    [[nodiscard]] WinnerKey* data() { return keys_.data(); }
    [[nodiscard]] WinnerKey* row(int y) {
        return keys_.data() + static_cast<std::size_t>(y & (slots_ - 1)) * static_cast<std::size_t>(width_);
    }

private:
    int width_ = 0;
    int slots_ = 0;
    std::vector<WinnerKey> keys_;
};

}  // namespace lw
