#include "client_renderer/guard_band.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {

namespace {

// Over which the speed of the head is measured: well within what the predictor extrapolates.
constexpr Duration kSpeedSpan = std::chrono::milliseconds{20};

// Whole pixels that a side at `tangent` (positive outwards) grows by. A band that is a whole number of pixels but for
// rounding is that number.
int extra_px(double tangent, double band_rad, double tan_per_px) {
    const double angle_rad = std::min(std::atan(tangent) + band_rad, kWidestHalfAngleRad);
    const double extra_tan = std::tan(angle_rad) - tangent;
    return extra_tan <= 0.0 ? 0 : static_cast<int>(std::ceil(extra_tan / tan_per_px - 1e-9));
}

}  // namespace

Camera with_guard_band(const Camera& target, double band_rad) {
    LW_CHECK(band_rad >= 0.0, fmt::format("a guard band of {} radians", band_rad));
    if (band_rad == 0.0) return target;
    const FovTangents& fov = target.fov;
    const double tan_per_px_x = (fov.right - fov.left) / target.size_px.x;
    const double tan_per_px_y = (fov.up - fov.down) / target.size_px.y;
    const int left_px = extra_px(-fov.left, band_rad, tan_per_px_x);
    const int right_px = extra_px(fov.right, band_rad, tan_per_px_x);
    const int down_px = extra_px(-fov.down, band_rad, tan_per_px_y);
    const int up_px = extra_px(fov.up, band_rad, tan_per_px_y);
    Camera source = target;
    source.size_px += glm::ivec2{left_px + right_px, down_px + up_px};
    source.fov = {fov.left - left_px * tan_per_px_x, fov.right + right_px * tan_per_px_x,
                  fov.down - down_px * tan_per_px_y, fov.up + up_px * tan_per_px_y};
    return source;
}

double pixels_ratio(const Camera& source, const Camera& target) {
    return static_cast<double>(source.size_px.x) * source.size_px.y /
           (static_cast<double>(target.size_px.x) * target.size_px.y);
}

double widest_guard_band_rad(const Camera& target, double max_ratio) {
    LW_CHECK(max_ratio >= 1.0, fmt::format("a ratio of {}", max_ratio));
    double fits = 0.0;
    double too_wide = kWidestHalfAngleRad;
    if (pixels_ratio(with_guard_band(target, too_wide), target) <= max_ratio) return too_wide;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (fits + too_wide);
        (pixels_ratio(with_guard_band(target, middle), target) <= max_ratio ? fits : too_wide) = middle;
    }
    return fits;
}

GuardBandSizer::GuardBandSizer(const Camera& target) {
    const double widest_rad = widest_guard_band_rad(target, kMostPixels);
    steps_rad_ = {0.0, 0.5 * widest_rad, widest_rad};
    auto predictor = make_predictor("constant-velocity");
    LW_CHECK(predictor.ok(), "no predictor of constant velocity");
    predictor_ = *std::move(predictor);
}

double GuardBandSizer::next_rad(const HeadPoseFeed& head, TimePoint now, Duration oldest_age) {
    const Pose here = predictor_->predict(head, now, now).world_from_head;
    const Pose later = predictor_->predict(head, now, now + kSpeedSpan).world_from_head;
    const double rad_per_s = angle_between_rad(here.orientation, later.orientation) / to_seconds(kSpeedSpan);
    const double turn_rad = rad_per_s * to_seconds(oldest_age);
    const auto step_for = [&](double rad) -> std::size_t {
        if (rad < kNoTurnRad) return 0;
        return rad <= steps_rad_[1] ? 1 : 2;
    };
    if (step_for(turn_rad) > step_) {
        step_ = step_for(turn_rad);
    } else if (step_for(turn_rad / kShrinkBelow) < step_) {
        --step_;
    }
    return steps_rad_[step_];
}

}  // namespace lw
