#pragma once
/// A Kalman filter of a head's pose, turning and acceleration, with its orientation on the sphere.

#include <array>
#include <optional>

#include "frame_link/head_sample_stream.h"

namespace lw {

/// Error-state filter: the orientation is a unit quaternion, and the filter's error, angular velocity and angular
/// acceleration are vectors in the head's own frame; a sample's deviation is its rotation vector from the expected
/// orientation. Accelerations die away by themselves (Singer, "Estimating optimal tracking filter performance for
/// manned maneuvering targets", 1970). All axes are alike, so that three of them share one 3x3 covariance; position is
/// filtered the same way in the world. One thread; no allocation.
class KalmanHeadFilter {
public:
    /// The next sample of a stream, later than the one before.
    void add(const SoundSample& sample);

    [[nodiscard]] const std::optional<SoundSample>& newest() const { return newest_; }

    /// The pose this long after the newest sample (programmer error without one); the velocity decays with the horizon
    /// (steady_span()).
    [[nodiscard]] Pose pose_after(Duration ahead) const;

private:
    /// What the filter assumes of three like axes; x is an angle or a length.
    struct Noise {
        double sample_variance;       ///< of one sample, x^2
        double acceleration_density;  ///< of the noise that drives the acceleration, (x/s^2)^2 / s
    };
    using Covariance = std::array<std::array<double, 3>, 3>;
    /// Value, velocity and acceleration of three like axes.
    struct Axes {
        glm::dvec3 velocity{0.0};
        glm::dvec3 acceleration{0.0};
        Covariance covariance{};

        void restart();
        /// What `seconds` do to the value; velocity and acceleration move on.
        [[nodiscard]] glm::dvec3 advance(double seconds, const Noise& noise);
        /// Takes in a deviation of the sample from the expected value; what it corrects of the value.
        [[nodiscard]] glm::dvec3 correct(const glm::dvec3& deviation, const Noise& noise);
        [[nodiscard]] glm::dvec3 ahead(double seconds) const;
    };
    static constexpr Noise kTurnNoise{1e-6, 2e3};  ///< rad: 0.06 degrees
    static constexpr Noise kMoveNoise{1e-6, 2e2};  ///< m: 1 mm

    Pose pose_;
    Axes turn_;
    Axes move_;
    std::optional<SoundSample> newest_;
};

}  // namespace lw
