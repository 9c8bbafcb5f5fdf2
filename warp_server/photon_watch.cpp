#include "warp_server/photon_watch.h"

#include "core/check.h"

namespace lw {

PhotonWatch::PhotonWatch(const SteadyRefreshes& refreshes, const PhotonWatchSettings& settings)
    : refreshes_{refreshes}, settings_{settings}, codes_(static_cast<std::size_t>(settings.strips)) {
    LW_CHECK(settings.strips >= 1, "a display of no strips");
    seen_.resize(settings.reserved_parts);  // written, so that no scan waits for the machine to find memory
    seen_.clear();
}

TimePoint PhotonWatch::scanout_begin(std::uint64_t slot) const {
    const auto strips = static_cast<std::uint64_t>(settings_.strips);
    const TimePoint begin = refreshes_.scanout_begin(slot / strips);
    const Duration period = refreshes_.scanout_begin(slot / strips + 1) - begin;
    return begin + period * static_cast<Duration::rep>(slot % strips) / settings_.strips;
}

void PhotonWatch::changed(const ColourImage& picture, const Strip& place, TimePoint now) {
    if (!next_slot_) {
        next_slot_ = refreshes_.after(now).number * static_cast<std::uint64_t>(settings_.strips);
    }
    scan_until(now);
    for (int index = 0; index < settings_.strips; ++index) {
        const Strip strip = strip_at(index, settings_.strips, picture.height());
        const bool touched = strip.top_px < place.top_px + place.height_px && strip.top_px >= place.top_px;
        if (touched) {
            codes_[static_cast<std::size_t>(index)] = read_photon_code(picture, strip.top_px, strip.height_px);
        }
    }
}

void PhotonWatch::scan_until(TimePoint now) {
    if (!next_slot_) return;
    const auto strips = static_cast<std::uint64_t>(settings_.strips);
    for (TimePoint begin = scanout_begin(*next_slot_); begin <= now; begin = scanout_begin(*next_slot_)) {
        const Duration half_strip = (scanout_begin(*next_slot_ + 1) - begin) / 2;
        const Duration latency = settings_.panel_latency ? settings_.panel_latency(begin) : Duration::zero();
        const auto strip = static_cast<std::size_t>(*next_slot_ % strips);
        seen_.push_back({*next_slot_ / strips, static_cast<int>(strip), begin + half_strip + latency, codes_[strip]});
        ++*next_slot_;
    }
}

}  // namespace lw
