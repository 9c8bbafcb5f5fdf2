#pragma once
/// The time line of a client that draws in shells: which item was drawn when, why and at what cost.

#include <string>
#include <vector>

#include "apps/report.h"
#include "client_renderer/shell_client.h"

namespace lw {

/// Adds `shells{items_drawn, redraw_fraction, invalid_items, spent_ms, budget_ms}` as distributions over the client's
/// frames, and `shells/frames_over_budget`, `frames_without_redraw` as shares of them. `redraw_fraction` is the time
/// spent over that of drawing everything. The first record, of the warm-up, is left out where there are more.
void describe_shells(Report& report, const std::vector<ShellFrameRecord>& records);

/// One row per item drawn: frame, time_s, item, reason, error_px, cost_ms, age_s, budget_ms. A frame that drew nothing
/// has one row without an item.
[[nodiscard]] std::string shell_timeline_csv(const std::vector<ShellFrameRecord>& records);

/// Items over time as SVG, one series per reason.
[[nodiscard]] std::string shell_timeline_svg(const std::vector<ShellFrameRecord>& records);

}  // namespace lw
