#pragma once
/// Refreshes at an exact rate, and the parts of each when it is scanned out in strips.

#include <algorithm>
#include <cmath>

#include "warp_server/presenter.h"

namespace lw {

/// Refresh n begins to scan out at start + n / hz; computed from the start, so that no rounding adds up. Pure.
struct SteadyRefreshes {
    TimePoint start;
    double hz = 90.0;

    [[nodiscard]] TimePoint scanout_begin(std::uint64_t number) const {
        return start + from_seconds(static_cast<double>(number) / hz);
    }
    /// The first refresh whose scan-out begins after `now`.
    [[nodiscard]] Refresh after(TimePoint now) const {
        auto number = static_cast<std::uint64_t>(std::max(0.0, std::floor(to_seconds(now - start) * hz)));
        // The product may round either way at the boundary; the first one after now is what counts.
        while (scanout_begin(number) <= now) ++number;
        while (number > 0 && scanout_begin(number - 1) > now) --number;
        return {number, scanout_begin(number), scanout_begin(number + 1) - scanout_begin(number)};
    }
};

/// The first strip of a rolling scan-out that begins after `now`, as a refresh of a display `count` times as fast: its
/// number is the refresh's times `count` plus the strip's index, so that photon() is the middle of the strip.
/// With one strip it is the presenter's next refresh. Pure.
[[nodiscard]] inline Refresh next_slot(const Presenter& presenter, TimePoint now, int count) {
    const Refresh next = presenter.next_refresh(now);
    if (count <= 1) return next;
    const auto strips = static_cast<std::uint64_t>(count);
    const auto slot_of = [&](std::uint64_t refresh, TimePoint scanout, int strip) {
        return Refresh{refresh * strips + static_cast<std::uint64_t>(strip), scanout + next.period * strip / count,
                       next.period / count};
    };
    if (next.number > 0) {
        for (int strip = 1; strip < count; ++strip) {
            const Refresh slot = slot_of(next.number - 1, next.scanout_begin - next.period, strip);
            if (slot.scanout_begin > now) return slot;
        }
    }
    return slot_of(next.number, next.scanout_begin, 0);
}

/// Where strip `index` of `count` lies in a picture `height_px` high. Pure.
[[nodiscard]] inline Strip strip_at(int index, int count, int height_px) {
    const int top_px = height_px * index / count;
    return {index, count, top_px, height_px * (index + 1) / count - top_px};
}

/// The camera that sees the rows of `strip` in `camera`'s picture and nothing else, pixel for pixel. Pure.
[[nodiscard]] inline Camera camera_of(const Camera& camera, const Strip& strip) {
    const double tangent_per_px = (camera.fov.up - camera.fov.down) / camera.size_px.y;
    const int bottom_px = strip.top_px + strip.height_px;
    Camera rows = camera;
    rows.size_px.y = strip.height_px;
    // The whole picture keeps its tangents to the last bit.
    if (strip.top_px != 0) rows.fov.up = camera.fov.up - tangent_per_px * strip.top_px;
    if (bottom_px != camera.size_px.y) rows.fov.down = camera.fov.up - tangent_per_px * bottom_px;
    return rows;
}

}  // namespace lw
