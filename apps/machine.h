#pragma once
/// What a report says of the machine it was made on, and what makes two reports comparable.

#include <string>

#include "gl/context.h"

namespace lw {

struct Machine {
    std::string cpu;
    int cores = 0;
    std::string gl_renderer;  ///< empty without a context
    std::string gl_version;   ///< the same
};

/// `context` may be null.
[[nodiscard]] Machine machine_of(const gl::Context* context);

/// With a surfaceless context made for the question, where that goes.
[[nodiscard]] Machine this_machine();

/// Times taken on one hold on the other: same processor, cores and GL. The version of the driver may differ.
[[nodiscard]] bool is_same_machine(const Machine& a, const Machine& b);

/// "AMD EPYC, 2 cores, llvmpipe".
[[nodiscard]] std::string text_of(const Machine& machine);

}  // namespace lw
