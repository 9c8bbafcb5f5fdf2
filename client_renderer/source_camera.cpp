#include "client_renderer/source_camera.h"

#include <cmath>

#include "core/check.h"

namespace lw {

Camera source_camera(const Camera& target, double density, double guard_band_rad) {
    LW_CHECK(density >= 1.0, fmt::format("a density of {}", density));
    Camera source = with_guard_band(target, guard_band_rad);
    source.size_px = {std::lround(density * source.size_px.x), std::lround(density * source.size_px.y)};
    return source;
}

SourceCameras::SourceCameras(const Camera& target, const SourceSettings& settings)
    : target_{target}, settings_{settings} {
    if (!settings_.guard_band_rad) sizer_.emplace(target_);
}

Camera SourceCameras::next(const HeadPoseFeed& head, TimePoint now, Duration oldest_age) {
    const double band_rad = sizer_ ? sizer_->next_rad(head, now, oldest_age) : *settings_.guard_band_rad;
    return source_camera(target_, settings_.density, band_rad);
}

Camera SourceCameras::largest() const {
    const double band_rad =
        sizer_ ? widest_guard_band_rad(target_, GuardBandSizer::kMostPixels) : *settings_.guard_band_rad;
    return source_camera(target_, settings_.density, band_rad);
}

}  // namespace lw
