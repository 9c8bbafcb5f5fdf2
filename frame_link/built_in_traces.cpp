#include "frame_link/built_in_traces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace lw {
namespace {

constexpr double kDuration_s = 60.0;
constexpr double kSample_s = 1.0 / 240.0;
constexpr double kPi = 3.14159265358979323846;
constexpr double kEyeHeight_m = 1.6;

/// Head angles (yaw left, pitch up, roll to the left, radians) and where the body carries the neck, metres.
struct HeadMotion {
    glm::dvec3 angles_rad{0.0};
    glm::dvec3 body_m{0.0};
};

double wave(double time_s, double hz, double phase = 0.0) { return std::sin(2.0 * kPi * hz * time_s + phase); }

// 0 to 1 with velocity and acceleration zero at both ends: the minimum-jerk profile that reaching and head turns
// follow.
double minimum_jerk(double t) {
    if (t <= 0.0) return 0.0;
    if (t >= 1.0) return 1.0;
    return t * t * t * (10.0 + t * (-15.0 + 6.0 * t));
}

// Eyes sit before and above the joint the head turns on, so a turn moves them too: about 10 cm and 8 cm.
Pose pose_of(const HeadMotion& motion) {
    const glm::dvec3 eye_from_neck_m{0.0, 0.08, -0.10};
    const glm::dquat orientation = glm::angleAxis(motion.angles_rad.x, glm::dvec3{0.0, 1.0, 0.0}) *
                                   glm::angleAxis(motion.angles_rad.y, glm::dvec3{1.0, 0.0, 0.0}) *
                                   glm::angleAxis(motion.angles_rad.z, glm::dvec3{0.0, 0.0, 1.0});
    const glm::dvec3 rest_m{0.0, kEyeHeight_m, 0.0};
    return {rest_m + motion.body_m + orientation * eye_from_neck_m - eye_from_neck_m, glm::normalize(orientation)};
}

template <class MotionAt>
Trace sampled(const char* name, MotionAt motion_at) {
    const auto count = static_cast<std::size_t>(std::lround(kDuration_s / kSample_s)) + 1;
    std::vector<TimedPose> poses;
    poses.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double time_s = static_cast<double>(i) * kSample_s;
        poses.push_back({time_s, pose_of(motion_at(time_s))});
    }
    return Trace{name, std::move(poses)};
}

Trace still() {
    const Pose pose = pose_of({});
    return Trace{"still", {{0.0, pose}, {kDuration_s, pose}}};
}

// Standing body: it sways by a few millimetres. Starts at rest.
glm::dvec3 sway_m(double time_s) {
    const double ease = minimum_jerk(time_s);
    return ease * glm::dvec3{0.006 * wave(time_s, 0.23), 0.002 * wave(time_s, 0.31), 0.008 * wave(time_s, 0.17)};
}

/// Where the head points between two turns of `look-around`, degrees: yaw, pitch, and how long a turn there takes.
struct Gaze {
    double yaw_deg, pitch_deg, turn_s;
};

// A turn every 1.25 s, back at the start after 15 s; a turn's peak speed is 1.875 * angle / turn_s, at most 152 deg/s.
constexpr std::array<Gaze, 12> kGazes{{{25.0, -4.0, 0.6},
                                       {60.0, 3.0, 0.6},
                                       {48.0, -18.0, 0.5},
                                       {5.0, -8.0, 0.7},
                                       {-35.0, 0.0, 0.6},
                                       {-70.0, 12.0, 0.6},
                                       {-58.0, -22.0, 0.7},
                                       {-10.0, -12.0, 0.6},
                                       {12.0, 20.0, 0.7},
                                       {85.0, 6.0, 0.9},
                                       {30.0, -3.0, 0.7},
                                       {0.0, 0.0, 0.6}}};
constexpr double kGazePeriod_s = 1.25;  // one turn and the dwell after it

glm::dvec3 gaze_angles_rad(double time_s) {
    const double round = time_s / kGazePeriod_s;
    const auto index = static_cast<std::size_t>(round);
    const Gaze& to = kGazes[index % kGazes.size()];
    const Gaze& from = kGazes[(index + kGazes.size() - 1) % kGazes.size()];
    const double turned = minimum_jerk((round - static_cast<double>(index)) * kGazePeriod_s / to.turn_s);
    const double yaw_deg = from.yaw_deg + (to.yaw_deg - from.yaw_deg) * turned;
    const double pitch_deg = from.pitch_deg + (to.pitch_deg - from.pitch_deg) * turned;
    // Heads lean into a turn a little.
    return glm::radians(glm::dvec3{yaw_deg, pitch_deg, 0.06 * yaw_deg});
}

HeadMotion look_around_at(double time_s) { return {gaze_angles_rad(time_s), sway_m(time_s)}; }

/// A walk around a long loop: straight, half turn to the left, straight back, half turn; twice in a minute.
class Walk {
public:
    Walk() : points_(static_cast<std::size_t>(std::lround(kLoop_m / kStep_m)) + 1) {
        for (std::size_t i = 1; i < points_.size(); ++i) {
            const double heading = heading_rad_at((static_cast<double>(i) - 0.5) * kStep_m);
            points_[i] = points_[i - 1] + kStep_m * glm::dvec3{-std::sin(heading), 0.0, -std::cos(heading)};
        }
    }

    [[nodiscard]] HeadMotion at(double time_s) const {
        const double ease = minimum_jerk(time_s / kStart_s);
        // Integral of the speed kSpeed * ease: the walker starts from rest.
        const double way_m = kSpeed_m_per_s * integral_of_ease(time_s);
        const double heading = heading_rad_at(way_m);
        // Steps at 1.8 Hz: the head rises and falls with each, and sways and rolls with every second.
        const glm::dvec3 bounce_m{0.015 * wave(time_s, 0.9), 0.02 * wave(time_s, 1.8, 1.2), 0.008 * wave(time_s, 1.8)};
        const glm::dvec3 nod_rad = glm::radians(glm::dvec3{1.5 * wave(time_s, 0.9, 0.4) + 12.0 * wave(time_s, 0.11),
                                                           1.2 * wave(time_s, 1.8, 0.8) + 5.0 * wave(time_s, 0.07),
                                                           0.8 * wave(time_s, 0.9, 0.9)});
        const glm::dquat heading_turn = glm::angleAxis(heading, glm::dvec3{0.0, 1.0, 0.0});
        return {glm::dvec3{heading, 0.0, 0.0} + ease * nod_rad, point_at(way_m) + ease * (heading_turn * bounce_m)};
    }

private:
    static constexpr double kStraight_m = 13.0;
    static constexpr double kTurn_m = 4.0;
    static constexpr double kLoop_m = 2.0 * (kStraight_m + kTurn_m);
    static constexpr double kStart_s = 1.5;
    // Two loops in a minute, less half of the time it takes to get going.
    static constexpr double kSpeed_m_per_s = 2.0 * kLoop_m / (kDuration_s - 0.5 * kStart_s);
    static constexpr double kStep_m = 0.002;

    static double integral_of_ease(double time_s) {
        if (time_s >= kStart_s) return time_s - 0.5 * kStart_s;
        const double t = time_s / kStart_s;
        return kStart_s * t * t * t * t * (2.5 + t * (-3.0 + t));
    }

    static double heading_rad_at(double way_m) {
        const double half_m = 0.5 * kLoop_m;
        const double halves = std::floor(way_m / half_m);
        return kPi * (halves + minimum_jerk((way_m - halves * half_m - kStraight_m) / kTurn_m));
    }

    [[nodiscard]] glm::dvec3 point_at(double way_m) const {
        const double along = std::fmod(way_m, kLoop_m) / kStep_m;
        const auto i = std::min(static_cast<std::size_t>(along), points_.size() - 2);
        return points_[i] + (points_[i + 1] - points_[i]) * (along - static_cast<double>(i));
    }

    std::vector<glm::dvec3> points_;
};

Trace walk() {
    const Walk path;
    return sampled("walk", [&path](double time_s) { return path.at(time_s); });
}

// "No", "yes" and a tilting "maybe" by turns, 5 s each, with pauses: up to 320 deg/s, as fast as people do shake.
HeadMotion shake_at(double time_s) {
    const double phase_s = std::fmod(time_s, 5.0);
    const double swell = minimum_jerk(phase_s / 0.8) * minimum_jerk((4.6 - phase_s) / 0.8);
    const int kind = static_cast<int>(time_s / 5.0) % 3;
    glm::dvec3 angles_deg{0.0};
    if (kind == 0) angles_deg = {24.0 * wave(phase_s, 2.1), 1.5 * wave(phase_s, 1.1), 2.0 * wave(phase_s, 2.1, 0.6)};
    if (kind == 1) angles_deg = {2.0 * wave(phase_s, 0.9), 16.0 * wave(phase_s, 1.9), 1.0 * wave(phase_s, 1.9, 0.5)};
    if (kind == 2) angles_deg = {6.0 * wave(phase_s, 1.3), 3.0 * wave(phase_s, 0.8), 14.0 * wave(phase_s, 1.5)};
    const glm::dvec3 lean_m{0.02 * wave(phase_s, 2.1), 0.005 * wave(phase_s, 1.9), 0.01 * wave(phase_s, 1.1)};
    return {swell * glm::radians(angles_deg), swell * lean_m + sway_m(time_s)};
}

// A flight over many objects: back and up to an overview, down among them to a tight turn 50 m on, and back out again.
// In the overview all is in view and far away; in the turn most is behind and the rest is near.
HeadMotion dive_at(double time_s) {
    const double up = minimum_jerk(time_s / 5.0);
    const double down = minimum_jerk((time_s - 20.0) / 11.0);
    const double out = minimum_jerk((time_s - 41.0) / 11.0);
    const double turn_rad = 2.0 * kPi * minimum_jerk((time_s - 29.0) / 13.0);
    const double inside = down - out;
    constexpr double kTurnRadius_m = 2.5;
    const glm::dvec3 circle_m = kTurnRadius_m * glm::dvec3{std::cos(turn_rad) - 1.0, 0.0, -std::sin(turn_rad)};
    const glm::dvec3 overview_m{3.0 * minimum_jerk((time_s - 5.0) / 15.0), 13.0 * (up - inside), 27.0 * up};
    const glm::dvec3 forward_m{0.0, 0.0, -77.0 * inside};
    return {{turn_rad, glm::radians(-15.0 * (up - 0.8 * inside)), 0.0}, overview_m + forward_m + circle_m};
}

}  // namespace

std::vector<std::string_view> built_in_trace_names() { return {"still", "look-around", "walk", "shake", "dive"}; }

std::optional<Trace> built_in_trace(std::string_view name) {
    if (name == "still") return still();
    if (name == "look-around") return sampled("look-around", look_around_at);
    if (name == "walk") return walk();
    if (name == "shake") return sampled("shake", shake_at);
    if (name == "dive") return sampled("dive", dive_at);
    return std::nullopt;
}

}  // namespace lw
