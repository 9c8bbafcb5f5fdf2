#include "warp_server/virtual_display.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {

VirtualDisplay::VirtualDisplay(TimePoint start, double hz, glm::ivec2 size_px)
    : start_{start}, hz_{hz}, picture_{size_px, Rgba8{0, 0, 0, 255}} {
    LW_CHECK(hz >= 1.0 && hz <= 1000.0, fmt::format("{} Hz", hz));
}

TimePoint VirtualDisplay::scanout_begin(std::uint64_t number) const {
    return start_ + from_seconds(static_cast<double>(number) / hz_);
}

Refresh VirtualDisplay::next_refresh(TimePoint now) const {
    const double refreshes_since_start = std::max(0.0, std::floor(to_seconds(now - start_) * hz_));
    auto number = static_cast<std::uint64_t>(refreshes_since_start);
    // The product may round either way at the boundary; the first one after now is what counts.
    while (scanout_begin(number) <= now) ++number;
    while (number > 0 && scanout_begin(number - 1) > now) --number;
    return {number, scanout_begin(number), scanout_begin(number + 1) - scanout_begin(number)};
}

void VirtualDisplay::present(const DisplayFrame& frame, const Refresh& refresh) {
    picture_.resize(frame.colour.size_px());
    std::ranges::copy(frame.colour.pixels(), picture_.pixels().begin());
    picture_refresh_ = refresh;
}

}  // namespace lw
