#pragma once
/// Counts calls of operator new on the calling thread, for tests that promise none.

#include <cstddef>

namespace lw::test {

/// Since the thread began.
[[nodiscard]] std::size_t allocations_on_this_thread();

}  // namespace lw::test
