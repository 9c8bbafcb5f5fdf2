#include "warp_server/methods/linear_colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/colour.h"

namespace lw {
namespace {

// 64-bit words with one channel of a stored value in its place.
struct ChannelTables {
    std::array<std::uint64_t, 256> red;
    std::array<std::uint64_t, 256> green;
    std::array<std::uint64_t, 256> blue;
};

const ChannelTables& channel_tables() {
    static const ChannelTables tables = [] {
        ChannelTables made{};
        for (std::size_t i = 0; i < 256; ++i) {
            const double linear = linear_from_srgb(static_cast<double>(i) / 255.0);
            const auto value = static_cast<std::uint64_t>(std::lround(linear * kLinearOne));
            made.red[i] = value;
            made.green[i] = value << 16U;
            made.blue[i] = value << 32U;
        }
        return made;
    }();
    return tables;
}

using Cubic = std::array<double, 4>;

// Through the curve at the four Chebyshev nodes of the octave: close to the smallest largest error.
Cubic cubic_of_octave(std::size_t octave) {
    const double low = octave == 0 ? 0.0 : std::ldexp(1.0, static_cast<int>(octave));
    const double high = std::ldexp(1.0, static_cast<int>(octave) + 1);
    std::array<double, 4> x{};
    std::array<double, 4> difference{};  // Newton's divided differences
    for (std::size_t i = 0; i < 4; ++i) {
        const double node = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / 4.0);
        x[i] = 0.5 * (low + high) + 0.5 * (high - low) * node;
        difference[i] = 255.0 * srgb_from_linear(std::min(1.0, x[i] / kLinearOne));
    }
    for (std::size_t order = 1; order < 4; ++order) {
        for (std::size_t i = 3; i >= order; --i) {
            difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - order]);
        }
    }
    Cubic cubic{difference[3], 0.0, 0.0, 0.0};
    for (std::size_t i = 3; i-- > 0;) {  // times (x - x_i), plus the next difference
        for (std::size_t power = 3; power > 0; --power) cubic[power] = cubic[power - 1] - x[i] * cubic[power];
        cubic[0] = difference[i] - x[i] * cubic[0];
    }
    return cubic;
}

}  // namespace

std::unique_ptr<std::uint64_t[]> linearise(const ColourImage& image) {
    const ChannelTables& tables = channel_tables();
    const std::span<const Rgba8> colours = image.pixels();
    const std::size_t spare = static_cast<std::size_t>(image.width()) + 8;
    auto linear = std::make_unique_for_overwrite<std::uint64_t[]>(colours.size() + spare);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        linear[i] = tables.red[colours[i].r] | tables.green[colours[i].g] | tables.blue[colours[i].b];
    }
    std::fill_n(linear.get() + colours.size(), spare, std::uint64_t{0});
    return linear;
}

const SrgbCubics& srgb_cubics() {
    static const SrgbCubics cubics = [] {
        SrgbCubics made;
        for (std::size_t octave = 0; octave < 16; ++octave) {
            const Cubic cubic = cubic_of_octave(octave);
            made.constant[octave] = static_cast<float>(cubic[0]);
            made.first[octave] = static_cast<float>(cubic[1]);
            made.second[octave] = static_cast<float>(cubic[2]);
            made.third[octave] = static_cast<float>(cubic[3]);
        }
        return made;
    }();
    return cubics;
}

const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table() {
    static const std::array<std::uint8_t, kLinearOne + 1> table = [] {
        std::array<std::uint8_t, kLinearOne + 1> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            made[i] = srgb8_from_linear15(static_cast<std::int32_t>(i), srgb_cubics());
        }
        return made;
    }();
    return table;
}

}  // namespace lw
