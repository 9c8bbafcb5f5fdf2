#include "apps/demo_overlay.h"

#include <fmt/format.h>

#include <algorithm>

namespace lw {

namespace {

constexpr Duration kPeriod = std::chrono::milliseconds{100};

std::vector<std::string> help_lines(const DemoControls& controls, const DemoState& state) {
    const double rate_hz = DemoControls::kAppRates_hz[controls.app_rate];
    return {fmt::format("M METHOD: {}   F {}   +/- CLIENT: {}   H HOLES{}", state.method,
                        controls.renderer_frozen ? "FROZEN" : "FREEZE",
                        rate_hz > 0.0 ? fmt::format("{:.0f} HZ", rate_hz) : "UNTHROTTLED",
                        controls.holes_shown ? ": SHOWN" : ""),
            fmt::format("DRAG LOOK   WASDEC MOVE   {}   L LAYERS   O OVERLAY   R {}   Q QUIT",
                        state.two_eyes ? std::string{"T EYES"} : fmt::format("P STRIPS {}", controls.strips.load()),
                        controls.recording ? fmt::format("RECORDING {}", state.frames_recorded) : "RECORD")};
}

}  // namespace

void DemoOverlay::note(const DisplayRecord& record) {
    const double missed = record.missed() ? 1000.0 : 0.0;
    missed_of_1000_ = missed_of_1000_ + (missed - missed_of_1000_) / 256.0;
    if (!record.presented) return;
    motion_to_photon_ms_ = to_ms(record.photon - record.pose_sampled);
    frame_age_ms_ = to_ms(record.photon - record.frame_pose_sampled);
    warp_ms_ = to_ms(record.warp_time());
}

bool DemoOverlay::is_due(TimePoint now) const { return now - shown_at_ >= kPeriod; }

std::vector<OverlayPanel> DemoOverlay::panels(TimePoint now, const DemoControls& controls, const DemoState& state) {
    shown_at_ = now;
    const int scale = std::max(1, size_px_.x / 512);
    std::vector<OverlayPanel> panels;
    ColourImage text = text_panel(help_lines(controls, state), size_px_.x, scale);
    const glm::ivec2 bottom_px{0, size_px_.y - text.height()};
    panels.push_back({std::move(text), bottom_px});
    if (!controls.overlay_shown) return panels;
    count_rate(now, state.frames_published);
    panels.push_back({bar_panel(bars(), size_px_.x / 2, scale), {0, 0}});
    return panels;
}

void DemoOverlay::count_rate(TimePoint now, std::uint64_t frames_published) {
    if (now - rate_counted_at_ <= from_seconds(1.0)) return;
    app_hz_ = static_cast<double>(frames_published - rate_counted_) / to_seconds(now - rate_counted_at_);
    rate_counted_ = frames_published;
    rate_counted_at_ = now;
}

std::vector<OverlayBar> DemoOverlay::bars() const {
    const double period_ms = 1e3 / display_hz_;
    return {{"MOTION TO PHOTON", motion_to_photon_ms_, 40.0, 2.0 * period_ms},
            {"FRAME AGE", frame_age_ms_, 400.0, 0.0},
            {"WARP", warp_ms_, 2.0 * period_ms, period_ms},
            {"CLIENT", app_hz_, 90.0, 0.0, "HZ"},
            {"MISSED OF 1000", missed_of_1000_, 100.0, 10.0, ""}};
}

}  // namespace lw
