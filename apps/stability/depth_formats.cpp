#include "apps/stability/depth_formats.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lw::stability {
namespace {

constexpr std::array kFormats{DepthFormat::float32_reversed, DepthFormat::float32_forward,
                              DepthFormat::float32_distance, DepthFormat::unorm24_reversed,
                              DepthFormat::unorm24_forward,  DepthFormat::unorm16_reversed,
                              DepthFormat::unorm16_forward,  DepthFormat::float16_reversed};
constexpr int kSamples = 4000;
constexpr double kSpread = 1.4142135623730951;

double rounded_to(double value, double step) { return std::nearbyint(value / step) * step; }

double unorm(double value, int bits) { return rounded_to(value, 1.0 / (std::ldexp(1.0, bits) - 1.0)); }

// Step of a float with `digits` bits after the leading one, and `least_exponent` where it turns subnormal.
double float_step(double value, int digits, int least_exponent) {
    const int exponent = value > 0.0 ? std::max(std::ilogb(value), least_exponent) : least_exponent;
    return std::ldexp(1.0, exponent - digits);
}

double float16(double value) { return rounded_to(value, float_step(value, 10, -14)); }

double float32(double value) { return static_cast<double>(static_cast<float>(value)); }

}  // namespace

std::span<const DepthFormat> depth_formats() { return kFormats; }

std::string_view name_of(DepthFormat format) {
    switch (format) {
        case DepthFormat::float32_reversed:
            return "float32 reversed";
        case DepthFormat::float32_forward:
            return "float32 forward";
        case DepthFormat::float32_distance:
            return "float32 distance";
        case DepthFormat::unorm24_reversed:
            return "unorm24 reversed";
        case DepthFormat::unorm24_forward:
            return "unorm24 forward";
        case DepthFormat::unorm16_reversed:
            return "unorm16 reversed";
        case DepthFormat::unorm16_forward:
            return "unorm16 forward";
        case DepthFormat::float16_reversed:
            return "float16 reversed";
    }
    return {};
}

double stored_depth(DepthFormat format, double distance_m, double near_m) {
    const double reversed = near_m / distance_m;
    switch (format) {
        case DepthFormat::float32_reversed:
            return float32(reversed);
        case DepthFormat::float32_forward:
            return 1.0 - float32(1.0 - reversed);
        case DepthFormat::float32_distance:
            return float32(near_m / float32(distance_m));
        case DepthFormat::unorm24_reversed:
            return unorm(reversed, 24);
        case DepthFormat::unorm24_forward:
            return 1.0 - unorm(1.0 - reversed, 24);
        case DepthFormat::unorm16_reversed:
            return unorm(reversed, 16);
        case DepthFormat::unorm16_forward:
            return 1.0 - unorm(1.0 - reversed, 16);
        case DepthFormat::float16_reversed:
            return float16(reversed);
    }
    return reversed;
}

double predicted_relative_error(DepthFormat format, double distance_m, double near_m) {
    const double reversed = near_m / distance_m;
    // Half a step of near / distance, over near / distance.
    double half_step = 0.0;
    switch (format) {
        case DepthFormat::float32_reversed:
            half_step = 0.5 * float_step(reversed, 23, -126);
            break;
        case DepthFormat::float32_forward:
            half_step = 0.5 * float_step(1.0 - reversed, 23, -126);
            break;
        case DepthFormat::float32_distance:
            half_step =
                0.5 * float_step(reversed, 23, -126) + reversed * 0.5 * float_step(distance_m, 23, -126) / distance_m;
            break;
        case DepthFormat::unorm24_reversed:
        case DepthFormat::unorm24_forward:
            half_step = 0.5 / (std::ldexp(1.0, 24) - 1.0);
            break;
        case DepthFormat::unorm16_reversed:
        case DepthFormat::unorm16_forward:
            half_step = 0.5 / (std::ldexp(1.0, 16) - 1.0);
            break;
        case DepthFormat::float16_reversed:
            half_step = 0.5 * float_step(reversed, 10, -14);
            break;
    }
    return std::min(half_step / reversed, 1.0);
}

DepthError measure_depth_error(DepthFormat format, double distance_m, double near_m) {
    DepthError error{distance_m, 0.0, 0.0, 0.0};
    for (int i = 0; i < kSamples; ++i) {
        const double sample_m = std::max(near_m, distance_m * std::pow(kSpread, 2.0 * (i + 0.5) / kSamples - 1.0));
        const double exact = near_m / sample_m;
        const double stored = stored_depth(format, sample_m, near_m);
        // In depth, not in distance: a depth that rounds to 0 is infinitely far, and its error is 1.
        error.relative = std::max(error.relative, std::abs(stored - exact) / exact);
        error.predicted_relative =
            std::max(error.predicted_relative, predicted_relative_error(format, sample_m, near_m));
        error.place_px = std::max(error.place_px, kFocal_px * kHeadTravel_m / near_m * std::abs(stored - exact));
    }
    return error;
}

}  // namespace lw::stability
