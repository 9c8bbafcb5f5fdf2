#include "warp_server/methods/linear_colour.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

void linearise(const ColourImage& image, std::vector<std::uint64_t>& linear) {
    const ChannelTables& tables = channel_tables();
    const std::span<const Rgba8> colours = image.pixels();
    linear.resize(colours.size() + static_cast<std::size_t>(image.width()) + 8);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        linear[i] = tables.red[colours[i].r] | tables.green[colours[i].g] | tables.blue[colours[i].b];
    }
    std::fill(linear.begin() + static_cast<std::ptrdiff_t>(colours.size()), linear.end(), 0);
}

const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table() {
    static const std::array<std::uint8_t, kLinearOne + 1> table = [] {
        std::array<std::uint8_t, kLinearOne + 1> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            made[i] = srgb8_from_linear(static_cast<float>(i) / static_cast<float>(kLinearOne));
        }
        return made;
    }();
    return table;
}

}  // namespace lw
