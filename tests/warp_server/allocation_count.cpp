#include "tests/warp_server/allocation_count.h"

#include <cstdlib>
#include <new>

namespace {
thread_local std::size_t allocation_count = 0;

void* counted_allocation(std::size_t size, std::size_t alignment) {
    ++allocation_count;
    // aligned_alloc wants a multiple of the alignment.
    const std::size_t rounded = (size + alignment - 1) / alignment * alignment;
    void* memory = std::aligned_alloc(alignment, rounded == 0 ? alignment : rounded);
    if (memory == nullptr) throw std::bad_alloc{};
    return memory;
}
}  // namespace

// The array forms call these by default; the nothrow forms of a sanitizer do not.
void* operator new(std::size_t size) { return counted_allocation(size, alignof(std::max_align_t)); }
void* operator new(std::size_t size, std::align_val_t alignment) {
    return counted_allocation(size, static_cast<std::size_t>(alignment));
}
void* operator new(std::size_t size, const std::nothrow_t& /*unused*/) noexcept {
    ++allocation_count;
    return std::malloc(size);
}
void operator delete(void* memory, const std::nothrow_t& /*unused*/) noexcept { std::free(memory); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace lw::test {

std::size_t allocations_on_this_thread() { return allocation_count; }

}  // namespace lw::test
