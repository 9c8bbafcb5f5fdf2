#pragma once
/// What a live run tells: the keys of `measure` and `demo` reports, and a few lines on standard error.

#include <optional>
#include <string>

#include "apps/latency_harness.h"
#include "apps/live_session.h"
#include "apps/report.h"
#include "core/statistics.h"

namespace lw {

/// The figures of one live run.
struct LiveSummary {
    MissCounts display;
    double app_hz = 0.0;  ///< published frames per second; 0 with fewer than two
    std::uint64_t app_frames = 0;
    std::uint64_t app_frames_dropped = 0;             ///< published and never shown
    std::optional<Distribution> motion_to_photon_ms;  ///< over refreshes: by the photons, else by time stamps
    std::optional<Distribution> frame_age_ms;
    std::optional<Distribution> jitter_ms;   ///< by the photons only
    std::optional<Distribution> judder_deg;  ///< by the photons only
    LatencyHarness harness;
    std::optional<Distribution> warp_ms;       ///< method and fill, wall time
    std::optional<Distribution> wake_late_ms;  ///< from the planned wake to the latch
    std::optional<Distribution> draw_ms;       ///< the client, from sampling to publishing
    WarpCounters left_out;                     ///< by all warps together
};

/// Pure.
[[nodiscard]] LiveSummary summary_of(const LiveResult& result);

/// Pixels of the rendered frames over those of the display, mean over the frames; 0 without frames. Pure.
[[nodiscard]] double source_pixels_ratio(const LiveResult& result);

/// `display`, `app`, `latency_ms`, `warp_ms`, `scheduling` and the rest.
void describe_live_run(Report& report, const Options& options, const LiveResult& result);

/// Every refresh with the times of its life, milliseconds since the run's clock began, and what was seen of it; empty
/// where there is none.
[[nodiscard]] std::string refreshes_csv(const LiveResult& result, const LatencyHarness& harness = {});

/// A few lines, for people.
[[nodiscard]] std::string live_summary_text(const Options& options, const LiveResult& result);

}  // namespace lw
