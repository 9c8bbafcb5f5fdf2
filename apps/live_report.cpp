#include "apps/live_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "apps/shell_report.h"
#include "apps/skip_report.h"

namespace lw {
namespace {

std::optional<Distribution> distribution_ms(const std::vector<Duration>& durations) {
    std::vector<double> ms;
    ms.reserve(durations.size());
    for (const Duration duration : durations) ms.push_back(to_ms(duration));
    return distribution_of(ms);
}

double published_hz(const std::vector<ClientFrameRecord>& frames) {
    if (frames.size() < 2) return 0.0;
    const Duration span = frames.back().times.published - frames.front().times.published;
    return static_cast<double>(frames.size() - 1) / to_seconds(span);
}

std::string_view cause_name(const DisplayRecord& refresh) {
    if (!refresh.missed()) return "";
    return refresh.cause == MissCause::late_wakeup ? "late_wakeup" : "own";
}

std::string_view injected_name(const std::optional<Injected>& injected) {
    if (!injected) return "settling";
    switch (*injected) {
        case Injected::tracker:
            return "tracker";
        case Injected::app:
            return "app";
        case Injected::present:
            return "present";
        case Injected::nothing:
            break;
    }
    return "";
}

std::string seen_columns(const SeenRefresh* seen) {
    if (seen == nullptr) return ",,,,,,";
    const auto optional = [](const std::optional<double>& value) {
        return value ? fmt::format("{:.4f}", *value) : std::string{};
    };
    return fmt::format(",{},{:.3f},{:.3f},{},{},{}", seen->frame, to_ms(seen->motion_to_photon), to_ms(seen->frame_age),
                       optional(seen->jitter_ms), optional(seen->judder_deg), injected_name(seen->injected));
}

/// The kernel counts stolen time in steps of 10 ms.
constexpr Duration kStealSpan = std::chrono::milliseconds{10};

std::string percentiles(const std::optional<Distribution>& distribution) {
    if (!distribution) return "-";
    return fmt::format("{:.1f} (p99 {:.1f})", distribution->p50, distribution->p99);
}

void take_photons(LiveSummary& summary) {
    if (!summary.harness.suspect.empty()) return;
    std::vector<Duration> motion;
    std::vector<Duration> age;
    std::vector<double> jitter_ms;
    std::vector<double> judder_deg;
    for (const SeenRefresh& refresh : summary.harness.refreshes) {
        if (refresh.injected != Injected::nothing) continue;
        motion.push_back(refresh.motion_to_photon);
        age.push_back(refresh.frame_age);
        if (refresh.jitter_ms) jitter_ms.push_back(*refresh.jitter_ms);
        if (refresh.judder_deg) judder_deg.push_back(*refresh.judder_deg);
    }
    summary.motion_to_photon_ms = distribution_ms(motion);
    summary.frame_age_ms = distribution_ms(age);
    summary.jitter_ms = distribution_of(jitter_ms);
    summary.judder_deg = distribution_of(judder_deg);
}

/// Refreshes that were missed because the thread was woken or held up, with how late and how much time was stolen.
void describe_late_wakeups(Report& report, const LiveResult& result) {
    std::vector<double> late_ms;
    std::vector<double> stolen_ms;
    for (const DisplayRecord& refresh : result.refreshes) {
        if (!refresh.missed() || refresh.cause != MissCause::late_wakeup) continue;
        const bool woken = refresh.presented.has_value();
        late_ms.push_back(
            to_ms(woken ? *refresh.presented - refresh.scanout_begin : refresh.photon - refresh.scanout_begin));
        stolen_ms.push_back(
            to_ms(result.steal.stolen(refresh.planned_wake - kStealSpan, refresh.scanout_begin + kStealSpan)));
    }
    report.set("display/late_wakeups/late_ms", std::span<const double>{late_ms});
    report.set("display/late_wakeups/stolen_ms", std::span<const double>{stolen_ms});
    report.set("display/stolen_ms", result.refreshes.empty()
                                        ? 0.0
                                        : to_ms(result.steal.stolen(result.refreshes.front().planned_wake,
                                                                    result.refreshes.back().scanout_begin)));
}

void describe_photons(Report& report, const Options& options, const LiveResult& result, const LatencyHarness& harness) {
    if (result.seen.empty()) {
        report.set_null("photon_check");
        return;
    }
    report.set("photon_check/codes_read", harness.codes_read);
    report.set("photon_check/codes_bad", harness.codes_bad);
    report.set("photon_check/in_phase", harness.in_phase);
    report.set("photon_check/in_phase_share", harness.in_phase_share);
    if (!harness.suspect.empty()) report.set("suspect", harness.suspect);
    if (!options.inject.any()) return;
    report.set("inject_ms/tracker", options.inject.tracker_ms);
    report.set("inject_ms/app", options.inject.app_ms);
    report.set("inject_ms/present", options.inject.present_ms);
    report.set("recovered_ms/tracker", harness.recovered.tracker_ms);
    report.set("recovered_ms/app", harness.recovered.app_ms);
    report.set("recovered_ms/present", harness.recovered.present_ms);
    const bool all_found = (!options.inject.tracker_ms || harness.recovered.tracker_ms) &&
                           (!options.inject.app_ms || harness.recovered.app_ms) &&
                           (!options.inject.present_ms || harness.recovered.present_ms);
    if (harness.suspect.empty() && !all_found) {
        report.set("suspect", "too few frames with and without a delay to compare: give it more --seconds");
    }
}

}  // namespace

LiveSummary summary_of(const LiveResult& result) {
    LiveSummary summary;
    summary.display = count_misses(result.refreshes);
    summary.app_hz = published_hz(result.app_frames);
    summary.app_frames = result.app_frames.size();
    summary.app_frames_dropped = summary.app_frames - std::min(summary.app_frames, result.app_frames_shown);

    if (result.seen.empty()) {
        // Nothing to read photons from (a window): the time stamps of both threads.
        const SeenLatencies seen = seen_latencies(result.refreshes);
        summary.motion_to_photon_ms = distribution_ms(seen.motion_to_photon);
        summary.frame_age_ms = distribution_ms(seen.frame_age);
    } else {
        summary.harness = latency_of(result);
        take_photons(summary);
    }

    std::vector<Duration> wake_late;
    for (const DisplayRecord& part : result.parts) {
        if (!part.presented) continue;
        wake_late.push_back(part.latched - part.planned_wake);
        summary.left_out += part.counters;
    }
    summary.warp_ms = distribution_ms(result.warp_times);
    summary.wake_late_ms = distribution_ms(wake_late);

    std::vector<Duration> draw;
    for (const ClientFrameRecord& frame : result.app_frames) {
        draw.push_back(frame.times.published - frame.times.pose_sampled);
    }
    summary.draw_ms = distribution_ms(draw);
    return summary;
}

double source_pixels_ratio(const LiveResult& result) {
    if (result.source_views.empty()) return 0.0;
    double sum = 0.0;
    for (const SourceView& view : result.source_views) sum += pixels_ratio(view.camera, result.display_camera);
    return sum / static_cast<double>(result.source_views.size());
}

void describe_live_run(Report& report, const Options& options, const LiveResult& result) {
    const LiveSummary summary = summary_of(result);
    report.set("settings/source_pixels_ratio", source_pixels_ratio(result));
    report.set("settings/strips", result.strips);
    report.set("display/hz", options.display_hz);
    report.set("display/refreshes", summary.display.refreshes);
    report.set("display/missed", summary.display.missed);
    report.set("display/missed_own", summary.display.own);
    report.set("display/missed_late_wakeup", summary.display.late_wakeup);
    report.set("display/in_window", result.in_window);
    report.set("app/hz", summary.app_hz);
    report.set("app/frames", summary.app_frames);
    if (!result.shells.empty()) describe_shells(report, result.shells);
    report.set("app/dropped", summary.app_frames_dropped);
    report.set("app/frame_ms", summary.draw_ms);
    report.set("latency_ms/motion_to_photon", summary.motion_to_photon_ms);
    report.set("latency_ms/frame_age", summary.frame_age_ms);
    report.set("latency_ms/jitter", summary.jitter_ms);
    report.set("latency_ms/wake_up", summary.wake_late_ms);
    report.set("judder_deg", summary.judder_deg);
    describe_photons(report, options, result, summary.harness);
    describe_late_wakeups(report, result);
    if (!result.app_failure.empty()) report.set("app/failure", result.app_failure);
    report.set("warp_ms", summary.warp_ms);
    report.set("scheduling", name_of(result.scheduling));
    report.set("counters/bad_depth_pixels", summary.left_out.bad_depth);
    report.set("counters/unknown_object_pixels", summary.left_out.unknown_object);
    report.set("counters/tiles_empty", summary.left_out.tiles_empty);
    report.set("counters/tiles_outside", summary.left_out.tiles_outside);
    report.set("counters/tiles_hidden", summary.left_out.tiles_hidden);
    report.set("counters/pictures_reused", summary.left_out.pictures_reused);
    report.set("counters/bad_head_poses", result.bad_head_poses);
    report.set("counters/bad_placements", result.bad_placements);
    report.set("counters/bad_layers", result.bad_layers);
    report.set("interrupted", result.interrupted);
    std::vector<DrawCounters> draws;
    for (const ClientFrameRecord& frame : result.app_frames) draws.push_back(frame.counters);
    describe_skipped(report, draws);
}

std::string refreshes_csv(const LiveResult& result, const LatencyHarness& harness) {
    std::unordered_map<std::uint64_t, const SeenRefresh*> seen;
    for (const SeenRefresh& refresh : harness.refreshes) seen[refresh.refresh] = &refresh;
    std::string csv =
        "refresh,frame,frame_pose_sampled_ms,pose_sampled_ms,planned_wake_ms,latched_ms,warp_begin_ms,warp_end_ms,"
        "presented_ms,scanout_begin_ms,photon_ms,missed,seen_frame,motion_to_photon_ms,frame_age_ms,jitter_ms,"
        "judder_deg,injected\n";
    for (const DisplayRecord& refresh : result.refreshes) {
        const auto ms = [](TimePoint time) { return fmt::format("{:.3f}", to_ms(time.time_since_epoch())); };
        const auto made_ms = [&](TimePoint time) { return refresh.presented ? ms(time) : std::string{}; };
        csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}", refresh.refresh, refresh.frame_index,
                           made_ms(refresh.frame_pose_sampled), made_ms(refresh.pose_sampled), ms(refresh.planned_wake),
                           made_ms(refresh.latched), made_ms(refresh.warp_begin), made_ms(refresh.warp_end),
                           made_ms(refresh.presented.value_or(TimePoint{})), ms(refresh.scanout_begin),
                           ms(refresh.photon), cause_name(refresh));
        const auto found = seen.find(refresh.refresh);
        csv += seen_columns(found == seen.end() ? nullptr : found->second) + "\n";
    }
    return csv;
}

std::string live_summary_text(const Options& options, const LiveResult& result) {
    const LiveSummary summary = summary_of(result);
    const double missed_percent = summary.display.refreshes == 0 ? 0.0
                                                                 : 100.0 * static_cast<double>(summary.display.missed) /
                                                                       static_cast<double>(summary.display.refreshes);
    std::string text;
    text += fmt::format("display  {} Hz, {} refreshes, {} missed ({:.2f} %): {} own, {} woken late\n",
                        options.display_hz, summary.display.refreshes, summary.display.missed, missed_percent,
                        summary.display.own, summary.display.late_wakeup);
    text += fmt::format("app      {:.1f} Hz, {} frames, {} of them never shown\n", summary.app_hz, summary.app_frames,
                        summary.app_frames_dropped);
    text += fmt::format("latency  motion to photon {} ms, frame age {} ms\n", percentiles(summary.motion_to_photon_ms),
                        percentiles(summary.frame_age_ms));
    if (!summary.harness.suspect.empty()) text += fmt::format("SUSPECT  {}\n", summary.harness.suspect);
    if (options.inject.any() && summary.harness.suspect.empty()) {
        const auto pair = [](const std::optional<double>& injected, const std::optional<double>& recovered) {
            if (!injected) return std::string{"-"};
            return fmt::format("{:.1f} -> {}", *injected, recovered ? fmt::format("{:.2f}", *recovered) : "?");
        };
        const RecoveredDelays& recovered = summary.harness.recovered;
        text += fmt::format(
            "injected tracker {}, app {}, present {} ms\n", pair(options.inject.tracker_ms, recovered.tracker_ms),
            pair(options.inject.app_ms, recovered.app_ms), pair(options.inject.present_ms, recovered.present_ms));
    }
    text += fmt::format("warp     {} {} ms, fill {}\n", options.method, percentiles(summary.warp_ms), options.fill);
    text += fmt::format("priority {}\n", name_of(result.scheduling));
    if (result.scheduling != Scheduling::fifo) text += fmt::format("         {}\n", realtime_advice());
    return text;
}

}  // namespace lw
