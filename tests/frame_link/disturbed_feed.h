#pragma once
/// A recording seen through a bad tracker.

#include <random>
#include <vector>

#include "frame_link/trace.h"

namespace lw::test {

/// What a tracker may do wrong; every kind is drawn from one seed.
struct Disturbance {
    double gap_every_s = 0.0;     ///< 0: no gaps
    double gap_s = 0.0;           ///< nothing arrives for so long
    double glitch_every_s = 0.0;  ///< 0: no glitches; single samples 20 degrees and 30 cm off
    double time_jitter_s = 0.0;   ///< standard deviation of the stamps
    double noise_rad = 0.0;       ///< standard deviation of each component of the orientation's error
    double noise_m = 0.0;
};

/// The samples of a tracker of `rate_hz` that plays `trace`, disturbed; stamps may go backwards. Immutable.
class DisturbedFeed final : public HeadPoseFeed {
public:
    DisturbedFeed(const Trace& trace, double rate_hz, const Disturbance& wrong) {
        std::mt19937 random{11};
        std::normal_distribution<double> normal;
        const auto three = [&](double scale) {
            const double x = normal(random);
            const double y = normal(random);
            return glm::dvec3{x, y, normal(random)} * scale;
        };
        const auto glitch_every = static_cast<std::size_t>(wrong.glitch_every_s * rate_hz);
        for (std::size_t k = 0; static_cast<double>(k) < trace.duration_s() * rate_hz; ++k) {
            const double time_s = static_cast<double>(k) / rate_hz;
            if (wrong.gap_every_s > 0.0 && std::fmod(time_s, wrong.gap_every_s) < wrong.gap_s) continue;
            Pose pose = trace.at(time_s);
            pose.position_m += three(wrong.noise_m);
            pose.orientation = pose.orientation * from_rotation_vector(three(wrong.noise_rad));
            if (glitch_every > 0 && k % glitch_every == glitch_every / 2) {
                pose.position_m.y += 0.3;
                pose.orientation = pose.orientation * from_rotation_vector({0.0, 0.35, 0.0});
            }
            const double jitter_s = normal(random) * wrong.time_jitter_s;
            samples_.push_back({at_seconds(std::max(0.0, time_s + jitter_s)), pose, samples_.size() + 1});
            arrived_.push_back(at_seconds(time_s));
        }
    }

    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        auto next =
            static_cast<std::size_t>(std::upper_bound(arrived_.begin(), arrived_.end(), now) - arrived_.begin());
        std::size_t filled = 0;
        while (next > 0 && filled < samples.size()) {
            --next;
            if (samples_[next].time <= now) samples[filled++] = samples_[next];
        }
        return filled;
    }

private:
    std::vector<PoseSample> samples_;
    std::vector<TimePoint> arrived_;  ///< ascending
};

}  // namespace lw::test
