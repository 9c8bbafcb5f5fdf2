#include "core/check.h"

#include <cstdio>
#include <cstdlib>

namespace lw {

void fail_check(std::string_view expression, std::string_view detail, const char* file, int line) {
    fmt::print(stderr, "check failed: {}: {} ({}:{})\n", expression, detail, file, line);
    std::fflush(stderr);
    std::abort();
}

}  // namespace lw
