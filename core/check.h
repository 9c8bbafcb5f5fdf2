#pragma once
/// Programmer errors: a check that prints what it saw and ends the process. Always on; cheap enough outside of
/// per-pixel loops.

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace lw {

/// Prints "check failed: EXPRESSION: DETAIL (FILE:LINE)" to standard error and aborts.
[[noreturn]] void fail_check(std::string_view expression, std::string_view detail, const char* file, int line);

}  // namespace lw

// `detail` is evaluated only when the check fails.
#define LW_CHECK(condition, detail)                                                   \
    do {                                                                              \
        if (!(condition)) ::lw::fail_check(#condition, (detail), __FILE__, __LINE__); \
    } while (false)

#define LW_CHECK_EQ(a, b)                                                                                             \
    do {                                                                                                              \
        const auto& lw_check_a = (a);                                                                                 \
        const auto& lw_check_b = (b);                                                                                 \
        if (!(lw_check_a == lw_check_b)) {                                                                            \
            ::lw::fail_check(#a " == " #b, fmt::format("{} against {}", lw_check_a, lw_check_b), __FILE__, __LINE__); \
        }                                                                                                             \
    } while (false)
