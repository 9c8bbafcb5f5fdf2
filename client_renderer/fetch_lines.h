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

}  // namespace lw
