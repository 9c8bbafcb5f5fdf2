#pragma once
/// What the demo's window shows over the picture: the keys, and on request live figures as bars.

#include <atomic>
#include <string>
#include <vector>

#include "apps/demo_controls.h"
#include "apps/overlay.h"
#include "core/clock.h"
#include "warp_server/display_record.h"

namespace lw {

/// What the help lines say beside the controls.
struct DemoState {
    std::string method;
    bool two_eyes = false;
    std::uint64_t frames_published = 0;
    std::size_t frames_recorded = 0;
};

/// note() is for the server's thread, the rest for the window's.
class DemoOverlay {
public:
    DemoOverlay(glm::ivec2 size_px, double display_hz) : size_px_{size_px}, display_hz_{display_hz} {}

    void note(const DisplayRecord& record);

    /// Whether the panels are a tenth of a second old, or were outdated.
    [[nodiscard]] bool is_due(TimePoint now) const;
    void outdate() { shown_at_ = TimePoint{}; }

    [[nodiscard]] std::vector<OverlayPanel> panels(TimePoint now, const DemoControls& controls, const DemoState& state);

private:
    void count_rate(TimePoint now, std::uint64_t frames_published);
    [[nodiscard]] std::vector<OverlayBar> bars() const;

    glm::ivec2 size_px_;
    double display_hz_;
    TimePoint shown_at_;
    TimePoint rate_counted_at_;
    std::uint64_t rate_counted_ = 0;
    double app_hz_ = 0.0;
    // Of the newest refresh.
    std::atomic<double> motion_to_photon_ms_{0.0};
    std::atomic<double> frame_age_ms_{0.0};
    std::atomic<double> warp_ms_{0.0};
    std::atomic<double> missed_of_1000_{0.0};
};

}  // namespace lw
