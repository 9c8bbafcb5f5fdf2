#include "frame_link/kalman_head_filter.h"

#include <cmath>

#include "core/check.h"
#include "frame_link/velocity_fit.h"

namespace lw {
namespace {

// How long an acceleration lasts. Over the recordings, 10 to 20 ms are alike; from 40 ms on the filter overshoots.
constexpr double kAcceleration_s = 0.012;

/// What an acceleration that dies away does in `seconds`, per unit of it.
struct Reach {
    double value;
    double velocity;
    double acceleration;
};
Reach reach_of(double seconds) {
    const double left = std::exp(-seconds / kAcceleration_s);
    const double velocity = kAcceleration_s * (1.0 - left);
    return {kAcceleration_s * (seconds - velocity), velocity, left};
}

}  // namespace

void KalmanHeadFilter::Axes::restart() {
    velocity = acceleration = glm::dvec3{0.0};
    // A head about which nothing is known moves at up to 3 rad/s or m/s, and may be 1 cm or half a degree off.
    covariance = {{{1e-4, 0.0, 0.0}, {0.0, 10.0, 0.0}, {0.0, 0.0, 100.0}}};
}

glm::dvec3 KalmanHeadFilter::Axes::advance(double seconds, const Noise& noise) {
    const Reach reach = reach_of(seconds);
    const glm::dvec3 moved = velocity * seconds + acceleration * reach.value;
    velocity += acceleration * reach.velocity;
    acceleration *= reach.acceleration;

    const Covariance step{{{1.0, seconds, reach.value}, {0.0, 1.0, reach.velocity}, {0.0, 0.0, reach.acceleration}}};
    Covariance half{};
    Covariance next{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            for (std::size_t k = 0; k < 3; ++k) half[i][j] += step[i][k] * covariance[k][j];
        }
    }
    // White noise on the acceleration, integrated over the step (a step is short beside kAcceleration_s).
    const double q = noise.acceleration_density * seconds;
    const double s = seconds;
    const Covariance added{{{q * s * s * s * s / 20.0, q * s * s * s / 8.0, q * s * s / 6.0},
                            {q * s * s * s / 8.0, q * s * s / 3.0, q * s / 2.0},
                            {q * s * s / 6.0, q * s / 2.0, q}}};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            next[i][j] = added[i][j];
            for (std::size_t k = 0; k < 3; ++k) next[i][j] += half[i][k] * step[j][k];
        }
    }
    covariance = next;
    return moved;
}

glm::dvec3 KalmanHeadFilter::Axes::correct(const glm::dvec3& deviation, const Noise& noise) {
    const double expected_variance = covariance[0][0] + noise.sample_variance;
    const std::array<double, 3> gain{covariance[0][0] / expected_variance, covariance[1][0] / expected_variance,
                                     covariance[2][0] / expected_variance};
    const std::array<double, 3> row = covariance[0];
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) covariance[i][j] -= gain[i] * row[j];
    }
    velocity += deviation * gain[1];
    acceleration += deviation * gain[2];
    return deviation * gain[0];
}

glm::dvec3 KalmanHeadFilter::Axes::ahead(double seconds) const {
    return velocity * steady_span(seconds) + acceleration * (seconds > 0.0 ? reach_of(seconds).value : 0.0);
}

void KalmanHeadFilter::add(const SoundSample& sample) {
    if (!newest_ || sample.restarts) {
        pose_ = sample.world_from_head;
        turn_.restart();
        move_.restart();
    } else {
        const double seconds = to_seconds(sample.time - newest_->time);
        pose_.orientation = pose_.orientation * from_rotation_vector(turn_.advance(seconds, kTurnNoise));
        pose_.position_m += move_.advance(seconds, kMoveNoise);
        const glm::dvec3 turned =
            rotation_vector(glm::conjugate(pose_.orientation) * sample.world_from_head.orientation);
        const glm::dvec3 moved = sample.world_from_head.position_m - pose_.position_m;
        pose_.orientation = glm::normalize(pose_.orientation * from_rotation_vector(turn_.correct(turned, kTurnNoise)));
        pose_.position_m += move_.correct(moved, kMoveNoise);
    }
    newest_ = sample;
}

Pose KalmanHeadFilter::pose_after(Duration ahead) const {
    LW_CHECK(newest_.has_value(), "a filter without a sample");
    const double seconds = to_seconds(ahead);
    return {pose_.position_m + move_.ahead(seconds),
            glm::normalize(pose_.orientation * from_rotation_vector(turn_.ahead(seconds)))};
}

}  // namespace lw
