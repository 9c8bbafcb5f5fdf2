#pragma once
/// A display as the server sees it: when it scans out, and where a finished picture goes.

#include <cstdint>

#include "core/clock.h"
#include "warp_server/warp_method.h"

namespace lw {

/// One refresh of a display.
struct Refresh {
    std::uint64_t number = 0;  ///< counts every refresh of the display, shown or missed
    TimePoint scanout_begin;
    Duration period{};
    /// Middle of the scan-out: what the head pose is predicted to.
    [[nodiscard]] TimePoint photon() const { return scanout_begin + period / 2; }
};

/// A part of the picture that is warped by itself, just before it is scanned out: rows [top_px, top_px + height_px).
struct Strip {
    int index = 0;
    int count = 1;
    int top_px = 0;
    int height_px = 0;
};

/// Called on the server thread only.
class Presenter {
public:
    virtual ~Presenter() = default;

    /// The first refresh whose scan-out begins after `now`.
    [[nodiscard]] virtual Refresh next_refresh(TimePoint now) const = 0;

    /// Hands over the picture for `refresh`. Copies or uploads what it needs; `frame` is the server's again afterwards.
    virtual void present(const DisplayFrame& frame, const Refresh& refresh) = 0;

    /// Hands over one strip of a picture that is made in strips. `strip` is as wide as the display and as high as the
    /// strip; `slot` is the strip's own share of a refresh (StripSchedule). As for present() otherwise.
    virtual void present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) = 0;

    /// True once the user closed the display; the server then ends its loop.
    [[nodiscard]] virtual bool closed() const { return false; }
};

}  // namespace lw
