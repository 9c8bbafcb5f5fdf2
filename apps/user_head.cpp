#include "apps/user_head.h"

#include <algorithm>
#include <cmath>

namespace lw {
namespace {

constexpr double kWalk_m_s = 1.5;
constexpr double kRun_m_s = 8.0;
constexpr double kRadPerPx = 0.002;  // a hand's width of mouse travel turns by about 90 degrees
constexpr double kLargestPitch_rad = 1.5;

glm::dquat orientation_of(double yaw_rad, double pitch_rad) {
    return glm::angleAxis(yaw_rad, glm::dvec3{0.0, 1.0, 0.0}) * glm::angleAxis(pitch_rad, glm::dvec3{1.0, 0.0, 0.0});
}

}  // namespace

void UserHead::advance(const HeadInput& input, Duration step, const Pose& follow) {
    if (!is_taken_) {
        pose_ = follow;
        if (input.empty()) return;
        is_taken_ = true;
        const glm::dvec3 forward = pose_.orientation * glm::dvec3{0.0, 0.0, -1.0};
        yaw_rad_ = std::atan2(-forward.x, -forward.z);
        pitch_rad_ = std::asin(std::clamp(forward.y, -1.0, 1.0));
    }
    yaw_rad_ -= input.turn_px.x * kRadPerPx;
    pitch_rad_ = std::clamp(pitch_rad_ - input.turn_px.y * kRadPerPx, -kLargestPitch_rad, kLargestPitch_rad);
    pose_.orientation = orientation_of(yaw_rad_, pitch_rad_);
    const double distance_m = (input.fast ? kRun_m_s : kWalk_m_s) * to_seconds(step);
    pose_.position_m += pose_.orientation * (input.move * distance_m);
}

}  // namespace lw
