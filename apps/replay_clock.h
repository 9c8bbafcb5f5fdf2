#pragma once
/// Replay's virtual clock: when each client frame is sampled, published and shown, and when each refresh happens.
///
/// Refresh n begins its scan-out at n / display_hz; its photon time is half a period later; the server latches `lead`
/// before the scan-out. Client frame k samples the head at k / app_hz, is published `app_latency` later and shown until
/// the next one is published.
///
/// The display starts with the first refresh that shows frame 1. Frame 0 is the warm-up: when it is sampled the tracker
/// has sent its first pose only, so there is no velocity to predict with, which no later frame meets again.

#include <cstdint>

#include "core/clock.h"
#include "warp_server/presenter.h"

namespace lw {

struct ReplayTiming {
    double app_hz = 10.0;      ///< > 0
    double display_hz = 90.0;  ///< > 0
    Duration app_latency{};    ///< from sampling the pose to publishing, >= 0
    Duration lead{};           ///< from latching to scan-out, >= 0
};

/// Pure arithmetic on whole nanoseconds, so that equal settings give equal schedules. Any thread.
class ReplayClock {
public:
    explicit ReplayClock(const ReplayTiming& timing) : timing_{timing} {}

    [[nodiscard]] TimePoint sampled(std::uint64_t frame) const {
        return at_seconds(static_cast<double>(frame) / timing_.app_hz);
    }
    [[nodiscard]] TimePoint published(std::uint64_t frame) const { return sampled(frame) + timing_.app_latency; }

    /// Photon time in the middle of the frame's life on the display: it is latched from its publishing until one client
    /// period later, and each latch is seen `lead` and half a refresh later. What the client predicts to.
    [[nodiscard]] TimePoint middle_of_life(std::uint64_t frame) const;

    /// Photon time of the last refresh that may show the frame: middle_of_life() and half a client period.
    [[nodiscard]] TimePoint end_of_life(std::uint64_t frame) const;

    [[nodiscard]] Refresh refresh(std::uint64_t number) const;
    [[nodiscard]] TimePoint latched(std::uint64_t number) const { return refresh(number).scanout_begin - timing_.lead; }

    /// Number of the first refresh that shows a frame after the warm-up.
    [[nodiscard]] std::uint64_t first_refresh() const;

    /// The newest frame published at or before the refresh's latch. `number` >= first_refresh().
    [[nodiscard]] std::uint64_t frame_shown_at(std::uint64_t number) const;

    static constexpr std::uint64_t kFirstShownFrame = 1;

private:
    ReplayTiming timing_;
};

}  // namespace lw
