#pragma once
/// Latency as the display's photons tell it: which head sample and which rendered frame each refresh showed, read back
/// from the codes in its pixels, and how far that can be trusted.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/live_session.h"

namespace lw {

/// One refresh as it was seen. With strips it is its worst one.
struct SeenRefresh {
    std::uint64_t refresh = 0;
    TimePoint photon;
    std::uint64_t frame = 0;           ///< index of the rendered frame
    Duration motion_to_photon{};       ///< photon minus the stamp of the head sample
    Duration frame_age{};              ///< photon minus the head sample its frame was drawn for
    std::optional<double> jitter_ms;   ///< change of motion-to-photon since the refresh before
    std::optional<double> judder_deg;  ///< how far the picture's turn since then is from the head's own
    std::optional<Injected> injected;  ///< nothing while an injected delay comes or goes
};

/// Delays found again, milliseconds.
struct RecoveredDelays {
    std::optional<double> tracker_ms;
    std::optional<double> app_ms;
    std::optional<double> present_ms;
};

struct LatencyHarness {
    std::vector<SeenRefresh> refreshes;  ///< whose code could be read, ascending
    std::uint64_t codes_read = 0;
    std::uint64_t codes_bad = 0;  ///< not readable, or of a picture that nobody made
    double in_phase_share = 0.0;  ///< of the codes that are those of the newest picture that was there in time
    bool in_phase = false;        ///< at least kInPhase of them
    RecoveredDelays recovered;
    /// Why the numbers cannot be trusted, empty if they can: then every latency is null.
    std::string suspect;

    static constexpr double kInPhase = 0.99;
    static constexpr std::uint64_t kFewestCodes = 300;
};

/// What the photons of a run tell. Latencies of refreshes during which a delay was injected are in `refreshes` and told
/// apart by `injected`. Pure.
[[nodiscard]] LatencyHarness latency_of(const LiveResult& result);

/// The delay that fits most frames: each was published at some time, was not there yet when the picture before the
/// first that shows it was latched, and was when that one was. So its delay lies between these latches less the time of
/// publication; the middle of where most of these intervals overlap. (By refreshes the intervals would move with the
/// pacer's lead.) Nothing without intervals. Pure.
struct DelayInterval {
    double from_ms;
    double to_ms;
};
[[nodiscard]] std::optional<double> most_common_delay_ms(const std::vector<DelayInterval>& intervals);

}  // namespace lw
