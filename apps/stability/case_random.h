#pragma once
/// Random numbers that are the same on every machine: the standard's distributions are not.

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

namespace lw::stability {

class CaseRandom {
public:
    explicit CaseRandom(std::uint64_t seed) : engine_{seed * 0x9E3779B97F4A7C15U + 1U} {}

    [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }  ///< in [0, 1)
    [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * unit(); }
    /// Equally often in every decade; 0 < low <= high.
    [[nodiscard]] double log_uniform(double low, double high) { return low * std::pow(high / low, unit()); }
    [[nodiscard]] int whole(int low, int high) {
        return low + static_cast<int>(engine_() % static_cast<std::uint64_t>(high - low + 1));
    }
    [[nodiscard]] bool chance(double probability) { return unit() < probability; }

    /// Evenly over the sphere.
    [[nodiscard]] glm::dvec3 direction() {
        const double z = uniform(-1.0, 1.0);
        const double angle = uniform(0.0, 6.283185307179586);
        const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
        return {r * std::cos(angle), r * std::sin(angle), z};
    }
    /// Evenly over all rotations (Shoemake 1992).
    [[nodiscard]] glm::dquat rotation() {
        const double u = unit();
        const double a = uniform(0.0, 6.283185307179586);
        const double b = uniform(0.0, 6.283185307179586);
        const glm::dquat q{std::sqrt(u) * std::cos(b), std::sqrt(1.0 - u) * std::sin(a),
                           std::sqrt(1.0 - u) * std::cos(a), std::sqrt(u) * std::sin(b)};
        return glm::normalize(q);
    }

private:
    std::mt19937_64 engine_;
};

}  // namespace lw::stability
