#include "scene/city_traffic.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "scene/random.h"

namespace lw::scene {

namespace {

constexpr double kTurnRadius_m = 6.0;
constexpr double kTurnSpeed = 4.6;     // m/s; 3.5 m/s^2 sideways
constexpr double kTopSpeed = 9.5;      // m/s
constexpr double kAcceleration = 1.7;  // m/s^2
constexpr double kSafeGap_s = 2.4;     // 11 m at the speed of turns
constexpr double kQuarterTurn_m = 0.5 * 3.14159265358979323846 * kTurnRadius_m;

glm::dvec3 forward_of(double heading_turns) {
    const Direction2 d = direction_of_turns(heading_turns);
    return {d.sine, 0.0, d.cosine};
}

glm::dvec3 right_of(double heading_turns) {
    const Direction2 d = direction_of_turns(heading_turns);
    return {-d.cosine, 0.0, d.sine};
}

}  // namespace

TrafficLoop::TrafficLoop(const CityLayout& layout, const BlockGroup& group) {
    const double west = layout.street_x_m(group.column) + kLane_m;
    const double east = layout.street_x_m(group.column + group.columns) - kLane_m;
    const double south = layout.street_z_m(group.row) - kLane_m;
    const double north = layout.street_z_m(group.row + group.rows) + kLane_m;
    centre_m_ = {0.5 * (west + east), 0.0, 0.5 * (south + north)};
    glm::dvec3 position{west, 0.0, south - kTurnRadius_m};
    double heading = 0.5;  // north
    const auto add = [&](double duration, double speed, double acceleration, bool turns) {
        legs_.push_back({round_s_, duration, position, heading, speed, acceleration, turns});
        round_s_ += duration;
        const CarState end = at(round_s_);
        position = end.position_m;
        heading = end.heading_turns;
    };
    for (int side = 0; side < 4; ++side) {
        const double length = (side % 2 == 0 ? south - north : east - west) - 2.0 * kTurnRadius_m;
        // Speed up, hold, brake; or meet in the middle when the street is short.
        const double reach = (kTopSpeed * kTopSpeed - kTurnSpeed * kTurnSpeed) / (2.0 * kAcceleration);
        const double run_up = std::min(reach, 0.5 * length);
        const double top = std::sqrt(kTurnSpeed * kTurnSpeed + 2.0 * kAcceleration * run_up);
        const double run_up_s = (top - kTurnSpeed) / kAcceleration;
        add(run_up_s, kTurnSpeed, kAcceleration, false);
        if (length > 2.0 * run_up + 1e-6) add((length - 2.0 * run_up) / top, top, 0.0, false);
        add(run_up_s, top, -kAcceleration, false);
        add(kQuarterTurn_m / kTurnSpeed, kTurnSpeed, 0.0, true);
    }
}

CarState TrafficLoop::at(double time_s) const {
    std::size_t i = 0;
    while (i + 1 < legs_.size() && time_s >= legs_[i].start_s + legs_[i].duration_s) ++i;
    const Leg& leg = legs_[i];
    const double t = time_s - leg.start_s;
    CarState state;
    if (leg.turns_right) {
        state.heading_turns = leg.heading_turns - 0.25 * t / leg.duration_s;
        const glm::dvec3 centre = leg.start_m + kTurnRadius_m * right_of(leg.heading_turns);
        state.position_m = centre - kTurnRadius_m * right_of(state.heading_turns);
        state.velocity_m_per_s = leg.speed * forward_of(state.heading_turns);
    } else {
        const glm::dvec3 forward = forward_of(leg.heading_turns);
        state.heading_turns = leg.heading_turns;
        state.position_m = leg.start_m + forward * (leg.speed * t + 0.5 * leg.acceleration * t * t);
        state.velocity_m_per_s = forward * (leg.speed + leg.acceleration * t);
    }
    return state;
}

int TrafficLoop::capacity() const { return static_cast<int>(0.75 * round_s_ / kSafeGap_s); }

void TrafficLoop::animate(int node, double phase_s, std::vector<AnimationChannel>& channels) const {
    // Keys in the time of the loop: ends of legs, and in curves quarters (a cubic over 22.5 degrees of a circle of 6 m
    // errs by less than 0.1 mm).
    std::vector<double> keys;
    for (const Leg& leg : legs_) {
        const int parts = leg.turns_right ? 4 : 1;
        for (int i = 0; i < parts; ++i) keys.push_back(leg.start_s + leg.duration_s * i / parts);
    }
    keys.push_back(phase_s);  // the seam: its time is both 0 and the end of the loop
    std::vector<double> times;
    for (const double key : keys) {
        const double time = key - phase_s;
        times.push_back(time < 0.0 ? time + round_s_ : time);
    }
    times.push_back(round_s_);
    std::sort(times.begin(), times.end());

    AnimationChannel move{node, AnimatedProperty::translation, Interpolation::cubic, round_s_, {}, {}};
    AnimationChannel turn{node, AnimatedProperty::rotation, Interpolation::linear, round_s_, {}, {}};
    for (std::size_t i = 0; i < times.size(); ++i) {
        const bool last = i + 1 == times.size();
        // Keys closer than a millisecond to the next (or, at the end, to the previous) add nothing.
        if (!last && i > 0 && times[i] - times[i - 1] < 1e-3) continue;
        if (!last && round_s_ - times[i] < 1e-3) continue;
        double in_loop = times[i] + phase_s;
        double rounds = 0.0;
        if (in_loop > round_s_) {
            in_loop -= round_s_;
            rounds = 1.0;
        }
        const CarState state = at(in_loop);
        const glm::vec4 velocity{glm::vec3{state.velocity_m_per_s}, 0.0f};
        const auto time = static_cast<float>(times[i]);
        move.times_s.push_back(time);
        move.values.insert(move.values.end(), {velocity, glm::vec4{glm::vec3{state.position_m}, 0.0f}, velocity});
        // Half the heading, unwrapped: neighbouring quaternions stay on the same half of the sphere.
        const Direction2 half = direction_of_turns(0.5 * (state.heading_turns - rounds));
        turn.times_s.push_back(time);
        turn.values.emplace_back(0.0f, static_cast<float>(half.sine), 0.0f, static_cast<float>(half.cosine));
    }
    move.loop_s = turn.loop_s = static_cast<double>(move.times_s.back());
    channels.push_back(std::move(move));
    channels.push_back(std::move(turn));
}

}  // namespace lw::scene
