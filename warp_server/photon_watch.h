#pragma once
/// The photon side of a virtual display: what a light sensor in front of it would read at every refresh.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "warp_server/photon_code.h"
#include "warp_server/steady_refreshes.h"

namespace lw {

/// A strip of one refresh as it left the display.
struct SeenPart {
    std::uint64_t refresh = 0;
    int strip = 0;
    TimePoint photon;                ///< when the middle of the strip was lit
    std::optional<PhotonCode> code;  ///< nothing where none could be read
};

struct PhotonWatchSettings {
    int strips = 1;
    std::size_t reserved_parts = 8192;  ///< parts that can be written down before memory grows
    /// The panel lights up this long after a scan-out at the given time; empty for at once. What the server is not
    /// told.
    std::function<Duration(TimePoint)> panel_latency;
};

/// Knows nothing of the server but the pixels: the code is read from what is in the display's memory when the strip's
/// scan-out begins. Pixels change only in changed(), so the scan-outs up to then are read there, exactly as a sensor
/// that watches all the time would. One thread; no allocation until the reserve is used up.
class PhotonWatch {
public:
    PhotonWatch(const SteadyRefreshes& refreshes, const PhotonWatchSettings& settings);

    /// The rows of `place` were replaced, the last of them at `now`: scan-outs until then showed what was there before.
    /// A whole picture is one strip of one, and holds the codes of all strips.
    void changed(const ColourImage& picture, const Strip& place, TimePoint now);

    /// Every scan-out that has begun until `now`, since the first picture.
    void scan_until(TimePoint now);

    [[nodiscard]] std::span<const SeenPart> seen() const { return seen_; }

private:
    [[nodiscard]] TimePoint scanout_begin(std::uint64_t slot) const;

    SteadyRefreshes refreshes_;
    PhotonWatchSettings settings_;
    std::vector<std::optional<PhotonCode>> codes_;  ///< in the display's memory now, one for each strip
    std::optional<std::uint64_t> next_slot_;        ///< nothing before the first picture
    std::vector<SeenPart> seen_;
};

}  // namespace lw
