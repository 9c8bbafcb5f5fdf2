#include "frame_link/adaptive_motion.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw {
namespace {

constexpr std::size_t kWeights = AdaptiveMotion::kWindows.size();
constexpr double kStep_s = to_seconds(AdaptiveMotion::kStep);

// Without anything learnt: the velocity of the last 16 to 32 ms, decaying over 150 ms.
constexpr std::array<double, kWeights> kPrior{0.0, 0.3, 0.7, 0.0, 0.0};
constexpr double kPriorDecay_s = 0.15;
// As much evidence as the memory's worth of samples of motion at 1.6 degrees/s and 2 cm/s: below that, what there is to
// learn from is the tracker's noise.
constexpr double kMemorySteps = AdaptiveMotion::kMemory_s / kStep_s;
constexpr double kTurnRidge = kMemorySteps * 0.028 * 0.028;
constexpr double kMoveRidge = kMemorySteps * 0.02 * 0.02;
// The recordings' fastest heads turn at 11.3 rad/s and move at 1.9 m/s; beyond that it is the tracker, or a headset
// taken off, and will not last.
constexpr double kFastestTurn_rad_per_s = 12.0;
constexpr double kFastestMove_m_per_s = 4.0;
constexpr Duration kLongestBack = std::chrono::milliseconds{32};

/// The largest speed among the velocities, as far as a head can be so fast.
double credible_speed(std::span<const glm::dvec3> velocities, double fastest) {
    double most = 0.0;
    for (const glm::dvec3& velocity : velocities) most = std::max(most, glm::length(velocity));
    return std::min(most, fastest);
}

glm::dvec3 limited(const glm::dvec3& vector, double longest) {
    const double length = glm::length(vector);
    return length > longest ? vector * (longest / length) : vector;
}

}  // namespace

AdaptiveMotion::AdaptiveMotion() = default;

void AdaptiveMotion::Fit::learn(const Velocities& seen, const glm::dvec3& velocity_after) {
    static const double keep = std::exp(-kStep_s / kMemory_s);
    for (std::size_t i = 0; i < kWeights; ++i) {
        for (std::size_t j = i; j < kWeights; ++j) matrix[i][j] = keep * matrix[i][j] + glm::dot(seen[i], seen[j]);
        right[i] = keep * right[i] + glm::dot(seen[i], velocity_after);
    }
}

// Cholesky's decomposition; the ridge keeps the matrix positive definite.
std::array<double, kWeights> AdaptiveMotion::Fit::weights(double ridge, double prior_scale) const {
    std::array<std::array<double, kWeights>, kWeights> lower{};
    std::array<double, kWeights> solution{};
    for (std::size_t i = 0; i < kWeights; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = matrix[j][i] + (i == j ? ridge : 0.0);
            for (std::size_t k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
            lower[i][j] = i == j ? std::sqrt(std::max(sum, 1e-3 * ridge)) : sum / lower[j][j];
        }
    }
    for (std::size_t i = 0; i < kWeights; ++i) {
        double sum = right[i] + ridge * prior_scale * kPrior[i];
        for (std::size_t k = 0; k < i; ++k) sum -= lower[i][k] * solution[k];
        solution[i] = sum / lower[i][i];
    }
    for (std::size_t i = kWeights; i-- > 0;) {
        double sum = solution[i];
        for (std::size_t k = i + 1; k < kWeights; ++k) sum -= lower[k][i] * solution[k];
        solution[i] = sum / lower[i][i];
    }
    return solution;
}

const AdaptiveMotion::Moment& AdaptiveMotion::moment(std::size_t steps_ago) const {
    return moments_[(moment_count_ - 1 - steps_ago) % kMoments];
}

void AdaptiveMotion::add(const SoundSample& sample) {
    if (!newest_ || sample.restarts) {
        moment_count_ = 0;
        step_to(sample.time, sample.world_from_head);
    } else {
        const double span_s = to_seconds(sample.time - newest_->time);
        while (newest_moment_ + kStep <= sample.time) {
            const TimePoint time = newest_moment_ + kStep;
            const double part = to_seconds(time - newest_->time) / span_s;
            step_to(time, interpolate(newest_->world_from_head, sample.world_from_head, part));
        }
    }
    newest_ = sample;
}

void AdaptiveMotion::step_to(TimePoint time, const Pose& pose) {
    Moment next;
    velocities_at(time, pose, next);
    moments_[moment_count_ % kMoments] = next;
    ++moment_count_;
    newest_moment_ = time;
    learn_from_newest_moment();
}

void AdaptiveMotion::learn_from_newest_moment() {
    const Pose& now = moment(0).pose;
    for (std::size_t i = 0; i < kHorizons.size(); ++i) {
        if (kHorizons[i] >= moment_count_) return;
        const Moment& then = moment(kHorizons[i]);
        const double per_second = 1.0 / (static_cast<double>(kHorizons[i]) * kStep_s);
        turn_fits_[i].learn(then.turn,
                            rotation_vector(glm::conjugate(then.pose.orientation) * now.orientation) * per_second);
        move_fits_[i].learn(then.move, (now.position_m - then.pose.position_m) * per_second);
    }
}

void AdaptiveMotion::velocities_at(TimePoint time, const Pose& pose, Moment& seen) const {
    seen.pose = pose;
    seen.turn.fill(glm::dvec3{0.0});
    seen.move.fill(glm::dvec3{0.0});
    if (moment_count_ == 0) return;
    const auto kept = static_cast<Duration::rep>(std::min(moment_count_, kMoments) - 1);
    const TimePoint oldest = newest_moment_ - kept * kStep;
    for (std::size_t i = 0; i < kWeights; ++i) {
        const TimePoint from = std::max(time - static_cast<Duration::rep>(kWindows[i]) * kStep, oldest);
        // A velocity over less than a step is the tracker's noise.
        if (time - from < kStep) return;
        const double per_second = 1.0 / to_seconds(time - from);
        const Pose past = past_pose(from);
        seen.turn[i] = rotation_vector(glm::conjugate(past.orientation) * pose.orientation) * per_second;
        seen.move[i] = (pose.position_m - past.position_m) * per_second;
    }
}

Pose AdaptiveMotion::past_pose(TimePoint time) const {
    const auto steps_ago = static_cast<std::size_t>((newest_moment_ - time) / kStep);
    const TimePoint after = newest_moment_ - static_cast<Duration::rep>(steps_ago) * kStep;
    if (after == time || steps_ago + 1 >= std::min(moment_count_, kMoments)) return moment(steps_ago).pose;
    const double part = to_seconds(after - time) / kStep_s;
    return interpolate(moment(steps_ago).pose, moment(steps_ago + 1).pose, part);
}

AdaptiveMotion::Displacement AdaptiveMotion::displacement(std::size_t horizon, const Moment& seen) const {
    const double seconds = static_cast<double>(kHorizons[horizon]) * kStep_s;
    const double prior_scale = kPriorDecay_s * (1.0 - std::exp(-seconds / kPriorDecay_s)) / seconds;
    const auto turn_weights = turn_fits_[horizon].weights(kTurnRidge, prior_scale);
    const auto move_weights = move_fits_[horizon].weights(kMoveRidge, prior_scale);
    Displacement sum;
    for (std::size_t i = 0; i < kWeights; ++i) {
        sum.turn_rad += seen.turn[i] * (turn_weights[i] * seconds);
        sum.move_m += seen.move[i] * (move_weights[i] * seconds);
    }
    return {limited(sum.turn_rad, credible_speed(seen.turn, kFastestTurn_rad_per_s) * seconds),
            limited(sum.move_m, credible_speed(seen.move, kFastestMove_m_per_s) * seconds)};
}

Pose AdaptiveMotion::pose_after(Duration ahead) const {
    LW_CHECK(newest_.has_value(), "a motion without a sample");
    Moment seen;
    velocities_at(newest_->time, newest_->world_from_head, seen);
    Displacement moved;
    const double steps = to_seconds(ahead) / kStep_s;
    if (ahead <= Duration::zero()) {
        const double back_s = to_seconds(std::max(ahead, -kLongestBack));
        moved = {seen.turn[1] * back_s, seen.move[1] * back_s};
    } else if (steps >= static_cast<double>(kHorizons.back())) {
        moved = displacement(kHorizons.size() - 1, seen);
    } else {
        // Between two horizons, and from none to the first, in proportion: they lie so close that a head's acceleration
        // bends off that line by less than 0.05 degrees below 50 ms.
        std::size_t next = 0;
        while (static_cast<double>(kHorizons[next]) <= steps) ++next;
        const double before_steps = next == 0 ? 0.0 : static_cast<double>(kHorizons[next - 1]);
        const double part = (steps - before_steps) / (static_cast<double>(kHorizons[next]) - before_steps);
        const Displacement before = next == 0 ? Displacement{} : displacement(next - 1, seen);
        const Displacement after = displacement(next, seen);
        moved = {glm::mix(before.turn_rad, after.turn_rad, part), glm::mix(before.move_m, after.move_m, part)};
    }
    const Pose& from = newest_->world_from_head;
    return {from.position_m + moved.move_m, glm::normalize(from.orientation * from_rotation_vector(moved.turn_rad))};
}

}  // namespace lw
