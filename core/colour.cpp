#include "core/colour.h"

#include <cmath>

namespace lw {
namespace {

// Finds the stored value of a linear one without a power function. A bucket spans 1/4096 of linear light, over which
// the encoded value rises by at most 12.92 * 255 / 4096 = 0.8 steps, so at most one threshold lies in it.
class Encoder {
public:
    Encoder() {
        for (std::size_t k = 0; k < 255; ++k) {
            threshold_[k] = static_cast<float>(linear_from_srgb((static_cast<double>(k) + 0.5) / 255.0));
        }
        std::size_t value = 0;
        for (std::size_t bucket = 0; bucket <= kBuckets; ++bucket) {
            const float begin = static_cast<float>(bucket) / static_cast<float>(kBuckets);
            while (value < 255 && begin >= threshold_[value]) ++value;
            first_value_[bucket] = static_cast<std::uint8_t>(value);
        }
    }

    [[nodiscard]] std::uint8_t encode(float linear) const {
        if (!(linear > 0.0F)) return 0;  // NaN too
        if (linear >= 1.0F) return 255;
        std::size_t value = first_value_[static_cast<std::size_t>(linear * static_cast<float>(kBuckets))];
        while (value < 255 && linear >= threshold_[value]) ++value;
        return static_cast<std::uint8_t>(value);
    }

private:
    static constexpr std::size_t kBuckets = 4096;
    std::array<float, 255> threshold_{};  ///< linear light halfway (in encoded steps) between values k and k + 1
    std::array<std::uint8_t, kBuckets + 1> first_value_{};
};

}  // namespace

double linear_from_srgb(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }

double srgb_from_linear(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

const std::array<float, 256>& linear_from_srgb8_table() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t k = 0; k < 256; ++k) {
            values[k] = static_cast<float>(linear_from_srgb(static_cast<double>(k) / 255.0));
        }
        return values;
    }();
    return table;
}

std::uint8_t srgb8_from_linear(float linear) {
    static const Encoder encoder;
    return encoder.encode(linear);
}

glm::vec3 linear_of(Rgba8 colour) {
    const std::array<float, 256>& table = linear_from_srgb8_table();
    return {table[colour.r], table[colour.g], table[colour.b]};
}

Rgba8 srgb8_of(const glm::vec3& linear) {
    return {srgb8_from_linear(linear.r), srgb8_from_linear(linear.g), srgb8_from_linear(linear.b), 255};
}

}  // namespace lw
