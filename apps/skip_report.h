#pragma once
/// What the client skipped, in every report.

#include <span>

#include "apps/report.h"
#include "client_renderer/scene_renderer.h"

namespace lw {

/// Sets skip/... to medians over the client's frames, plain numbers; nothing when there are none.
void describe_skipped(Report& report, std::span<const DrawCounters> frames);

}  // namespace lw
