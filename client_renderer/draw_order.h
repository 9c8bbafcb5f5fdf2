#pragma once
/// In which order draws go to the driver.

#include <cstddef>

#include "client_renderer/sorting_buffer.h"

namespace lw {

struct DrawOrder {
    /// By zone of distance, and within a zone by state. Off: every object by its distance, nearest first, through a
    /// sorting buffer.
    bool grouped = true;
    SortingStrategy strategy = SortingStrategy::none;  ///< of the buffer
    std::size_t capacity = 32;                         ///< draws that it holds, >= 1
};

}  // namespace lw
