#pragma once
/// For walks through memory that no hardware foresees.

#include <cstddef>

namespace lw {

/// Asks for the cache lines of an object that is read soon.
template <class T>
inline void fetch_lines(const T* object) {
    const auto* bytes = reinterpret_cast<const char*>(object);
    for (std::size_t line = 0; line < sizeof(T); line += 64) __builtin_prefetch(bytes + line);
}

/// Asks for those of a run of `count` objects, at least one.
template <class T>
inline void fetch_run(const T* first, std::size_t count) {
    const auto* bytes = reinterpret_cast<const char*>(first);
    for (std::size_t line = 0; line < count * sizeof(T); line += 64) __builtin_prefetch(bytes + line);
    __builtin_prefetch(bytes + count * sizeof(T) - 1);
}

}  // namespace lw
