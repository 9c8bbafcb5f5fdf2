#pragma once
/// Learns from a head's last moments how its motion goes on, and carries it on that way.

#include <array>
#include <cstddef>
#include <optional>

#include "frame_link/head_sample_stream.h"

namespace lw {

/// A linear predictor that fits itself to the head at hand. The displacement over a horizon is a weighted sum of the
/// mean velocities over the last 8, 16, 32, 64 and 128 ms; a head that turns smoothly wants the shortest windows with
/// their trend, one that shakes wants the long ones. The weights are those that would have predicted the last seconds
/// best: least squares with exponential forgetting, one set per horizon and one each for turning and moving, drawn
/// towards a velocity that decays with the horizon while there is little motion to learn from (a ridge).
///
/// One thread; no allocation. About 3 microseconds for every 4 ms of samples and 1 for a prediction.
class AdaptiveMotion {
public:
    AdaptiveMotion();

    /// The next sample of a stream, later than the one before.
    void add(const SoundSample& sample);

    [[nodiscard]] const std::optional<SoundSample>& newest() const { return newest_; }

    /// The pose this long after the newest sample (programmer error without one). Beyond the longest horizon, 192 ms,
    /// it holds still; before the newest sample it goes back at constant velocity for up to 32 ms. Always finite and
    /// never farther away than the fastest of the velocities leads.
    [[nodiscard]] Pose pose_after(Duration ahead) const;

    static constexpr Duration kStep = std::chrono::milliseconds{4};
    static constexpr std::array<std::size_t, 5> kWindows{2, 4, 8, 16, 32};                  ///< in steps
    static constexpr std::array<std::size_t, 9> kHorizons{2, 4, 6, 8, 12, 16, 24, 32, 48};  ///< in steps
    /// What is older counts for less by e. Over the recordings, 1 and 3 s differ by less than 2 %.
    static constexpr double kMemory_s = 1.5;

private:
    using Velocities = std::array<glm::dvec3, kWindows.size()>;  ///< per second, one for each window
    struct Moment {
        Pose pose;
        Velocities turn;  ///< rotation vectors, head's frame
        Velocities move;  ///< world
    };
    /// Normal equations of one horizon, in velocities, so that all horizons have one scale.
    struct Fit {
        std::array<std::array<double, kWindows.size()>, kWindows.size()> matrix{};
        std::array<double, kWindows.size()> right{};

        void learn(const Velocities& seen, const glm::dvec3& velocity_after);
        [[nodiscard]] std::array<double, kWindows.size()> weights(double ridge, double prior_scale) const;
    };
    struct Displacement {
        glm::dvec3 turn_rad{0.0};
        glm::dvec3 move_m{0.0};
    };

    [[nodiscard]] const Moment& moment(std::size_t steps_ago) const;
    void step_to(TimePoint time, const Pose& pose);
    void learn_from_newest_moment();
    /// Velocities over the windows that end at `time`; shorter ones while there is less history.
    void velocities_at(TimePoint time, const Pose& pose, Moment& seen) const;
    [[nodiscard]] Pose past_pose(TimePoint time) const;
    [[nodiscard]] Displacement displacement(std::size_t horizon, const Moment& seen) const;

    static constexpr std::size_t kMoments = 96;  ///< the longest window, the longest horizon, and some
    std::array<Moment, kMoments> moments_;       ///< a ring on a regular grid of times
    std::size_t moment_count_ = 0;               ///< since the last restart
    TimePoint newest_moment_;
    std::optional<SoundSample> newest_;
    std::array<Fit, kHorizons.size()> turn_fits_;
    std::array<Fit, kHorizons.size()> move_fits_;
};

}  // namespace lw
