#pragma once
/// Random numbers and trigonometry that give the same bits on every machine: built-in scenes must be equal everywhere,
/// and neither the standard library's distributions nor libm's last bits are.

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <initializer_list>

namespace lw::scene {

/// Scrambles 64 bits (the finaliser of splitmix64, Steele et al. 2014). Pure.
[[nodiscard]] constexpr std::uint64_t scrambled(std::uint64_t bits) {
    bits = (bits ^ (bits >> 30)) * 0xBF58476D1CE4E5B9ull;
    bits = (bits ^ (bits >> 27)) * 0x94D049BB133111EBull;
    return bits ^ (bits >> 31);
}

/// A splitmix64 stream. Equal seeds give equal numbers. One thread at a time.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_{seed} {}
    /// An independent stream for part `key` of whatever `seed` makes, so that parts can be made in any order.
    Random(std::uint64_t seed, std::uint64_t key) : state_{scrambled(seed + 0x632BE59BD9B4E019ull) ^ scrambled(key)} {}

    [[nodiscard]] std::uint64_t bits() { return scrambled(state_ += 0x9E3779B97F4A7C15ull); }
    /// In [0, 1).
    [[nodiscard]] double unit() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
    /// In [low, high).
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * unit(); }
    /// In [0, count); count > 0.
    [[nodiscard]] int below(int count) {
        return static_cast<int>(((bits() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
    }
    [[nodiscard]] bool chance(double probability) { return unit() < probability; }
    /// An element of an array or vector that is not empty.
    template <class Container>
    [[nodiscard]] const auto& pick(const Container& choices) {
        return choices[static_cast<std::size_t>(below(static_cast<int>(choices.size())))];
    }

private:
    std::uint64_t state_;
};

/// Cosine and sine of an angle.
struct Direction2 {
    double cosine = 1.0;
    double sine = 0.0;
};

/// Cosine and sine of `turns` full turns (any finite value) from + and * alone. Error below 1e-15. Pure.
[[nodiscard]] inline Direction2 direction_of_turns(double turns) {
    const double quarters = std::floor(turns * 4.0 + 0.5);
    const double x = (turns * 4.0 - quarters) * 1.57079632679489661923;  // [-pi/4, pi/4]
    const double x2 = x * x;
    // Taylor series: the first term left out is below 1e-16 at pi/4.
    double s = -1.0 / 1307674368000.0;
    for (const double term :
         {1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0}) {
        s = s * x2 + term;
    }
    s *= x;
    double c = 1.0 / 20922789888000.0;
    for (const double term : {-1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0, 1.0 / 40320.0, -1.0 / 720.0,
                              1.0 / 24.0, -0.5, 1.0}) {
        c = c * x2 + term;
    }
    switch (static_cast<int>(quarters - 4.0 * std::floor(quarters * 0.25))) {
        case 0:
            return {c, s};
        case 1:
            return {-s, c};
        case 2:
            return {-c, -s};
        default:
            return {s, -c};
    }
}

/// A direction uniform on the unit sphere.
[[nodiscard]] inline glm::dvec3 random_direction(Random& random) {
    const double y = random.between(-1.0, 1.0);
    const Direction2 around = direction_of_turns(random.unit());
    const double r = std::sqrt(1.0 - y * y);
    return {r * around.cosine, y, r * around.sine};
}

}  // namespace lw::scene
