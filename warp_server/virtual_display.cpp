#include "warp_server/virtual_display.h"

#include <algorithm>

#include "core/check.h"

namespace lw {

VirtualDisplay::VirtualDisplay(TimePoint start, double hz, glm::ivec2 size_px)
    : refreshes_{start, hz}, picture_{size_px, Rgba8{0, 0, 0, 255}} {
    LW_CHECK(hz >= 1.0 && hz <= 1000.0, fmt::format("{} Hz", hz));
}

Refresh VirtualDisplay::next_refresh(TimePoint now) const { return refreshes_.after(now); }

void VirtualDisplay::present(const DisplayFrame& frame, const Refresh& refresh) {
    picture_.resize(frame.colour.size_px());
    std::ranges::copy(frame.colour.pixels(), picture_.pixels().begin());
    picture_refresh_ = refresh;
    if (watch_) watch_->changed(picture_, {0, 1, 0, picture_.height()}, clock_->now());
}

void VirtualDisplay::present_strip(const DisplayFrame& strip, const Refresh& slot, const Strip& place) {
    LW_CHECK(strip.colour.width() == picture_.width() && place.top_px + place.height_px <= picture_.height(),
             "a strip of another display");
    const auto offset = static_cast<std::ptrdiff_t>(place.top_px) * picture_.width();
    std::ranges::copy(strip.colour.pixels(), picture_.pixels().begin() + offset);
    picture_refresh_ = slot;
    if (watch_) watch_->changed(picture_, place, clock_->now());
}

void VirtualDisplay::watch_photons(const Clock& clock, const PhotonWatchSettings& settings) {
    clock_ = &clock;
    watch_ = std::make_unique<PhotonWatch>(refreshes_, settings);
}

std::span<const SeenPart> VirtualDisplay::seen() {
    if (!watch_) return {};
    watch_->scan_until(clock_->now());
    return watch_->seen();
}

}  // namespace lw
