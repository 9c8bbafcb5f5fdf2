#pragma once
/// Scripted head motion. Names and what they share: trace.h.

#include <optional>
#include <string_view>

#include "frame_link/trace.h"

namespace lw {

/// The built-in trace of that name, or nothing. Pure, any thread.
[[nodiscard]] std::optional<Trace> built_in_trace(std::string_view name);

}  // namespace lw
