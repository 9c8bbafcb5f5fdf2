#include "frame_link/trace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/check.h"

namespace lw {
namespace {

// Below this length of its horizontal part a view direction has no trustworthy heading: within 10 degrees of vertical.
const double kSteepHorizontal = std::sin(glm::radians(10.0));

glm::dquat yaw(double angle_rad) { return glm::angleAxis(angle_rad, glm::dvec3{0.0, 1.0, 0.0}); }

void check_pose(const std::vector<TimedPose>& poses, std::size_t i) {
    const TimedPose& pose = poses[i];
    LW_CHECK(std::isfinite(pose.time_s), fmt::format("time of pose {} is {}", i, pose.time_s));
    LW_CHECK(i == 0 || poses[i - 1].time_s < pose.time_s,
             fmt::format("pose {}: {} s after {} s", i, pose.time_s, poses[i - 1].time_s));
    const std::optional<Pose> unit = sanitised(pose.world_from_head);
    // 1e-9: a hundred times what a handful of quaternion products can lose.
    LW_CHECK(unit && std::abs(glm::length(pose.world_from_head.orientation) - 1.0) < 1e-9,
             fmt::format("pose {} is not a rigid one", i));
}

}  // namespace

double heading_rad(const glm::dquat& orientation) {
    const glm::dvec3 forward = orientation * glm::dvec3{0.0, 0.0, -1.0};
    glm::dvec3 heading = forward;
    if (std::hypot(forward.x, forward.z) < kSteepHorizontal) {
        const glm::dvec3 up = orientation * glm::dvec3{0.0, 1.0, 0.0};
        heading = forward.y < 0.0 ? up : -up;  // looking down the crown leads, looking up the chin
    }
    return std::atan2(-heading.x, -heading.z);
}

Trace::Trace(std::string name, std::vector<TimedPose> poses, std::vector<std::string> warnings)
    : name_{std::move(name)}, poses_{std::move(poses)}, warnings_{std::move(warnings)} {
    LW_CHECK(!poses_.empty(), "a trace has at least one pose");
    for (std::size_t i = 0; i < poses_.size(); ++i) check_pose(poses_, i);
}

Pose Trace::at(double time_s) const {
    const double stamp_s = poses_.front().time_s + time_s;
    const auto after = std::upper_bound(poses_.begin(), poses_.end(), stamp_s,
                                        [](double t_s, const TimedPose& pose) { return t_s < pose.time_s; });
    if (after == poses_.begin()) return poses_.front().world_from_head;
    const TimedPose& a = *(after - 1);
    if (after == poses_.end() || a.time_s == stamp_s) return a.world_from_head;
    return interpolate(a.world_from_head, after->world_from_head, (stamp_s - a.time_s) / (after->time_s - a.time_s));
}

Trace Trace::placed_at(const Pose& start, double skip_s) const {
    const Pose first = at(skip_s);
    const glm::dquat turn = yaw(heading_rad(start.orientation) - heading_rad(first.orientation));
    const auto placed = [&](const Pose& pose) {
        return Pose{start.position_m + turn * (pose.position_m - first.position_m),
                    glm::normalize(turn * pose.orientation)};
    };
    const double begin_s = poses_.front().time_s + std::clamp(skip_s, 0.0, duration_s());
    std::vector<TimedPose> poses{{0.0, placed(first)}};
    for (const TimedPose& pose : poses_) {
        const double time_s = pose.time_s - begin_s;
        if (time_s > 0.0) poses.push_back({time_s, placed(pose.world_from_head)});
    }
    Trace trace{name_, std::move(poses), warnings_};
    trace.eye_fovs_ = eye_fovs_;
    return trace;
}

}  // namespace lw
