#include "warp_server/methods/linear_colour.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/colour.h"
#include "warp_server/methods/linear_kernels.h"

namespace lw {
namespace {

const std::array<std::uint16_t, 256>& linear15_from_srgb8_table() {
    static const std::array<std::uint16_t, 256> table = [] {
        std::array<std::uint16_t, 256> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            made[i] =
                static_cast<std::uint16_t>(std::lround(linear_from_srgb(static_cast<double>(i) / 255.0) * kLinearOne));
        }
        return made;
    }();
    return table;
}

using Parabola = std::array<double, 3>;

// Through the curve at the three Chebyshev nodes of [low, high): close to the smallest largest error.
Parabola parabola_between(double low, double high) {
    std::array<double, 3> x{};
    std::array<double, 3> difference{};  // Newton's divided differences
    for (std::size_t i = 0; i < 3; ++i) {
        const double node = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.5) / 3.0);
        x[i] = 0.5 * (low + high) + 0.5 * (high - low) * node;
        difference[i] = 255.0 * srgb_from_linear(std::clamp((x[i] - 1.0) / kLinearOne, 0.0, 1.0));
    }
    for (std::size_t order = 1; order < 3; ++order) {
        for (std::size_t i = 2; i >= order; --i) {
            difference[i] = (difference[i] - difference[i - 1]) / (x[i] - x[i - order]);
        }
    }
    return {difference[0] - x[0] * (difference[1] - x[1] * difference[2]),
            difference[1] - (x[0] + x[1]) * difference[2], difference[2]};
}

}  // namespace

LinearImage::LinearImage(const ColourImage& image, LinearAlpha alpha)
    : size_px_{image.size_px()},
      channels_{alpha == LinearAlpha::kept ? 4 : 3},
      channel_stride_{image.width() + kSpareColumns} {
    const auto stride = static_cast<std::size_t>(row_stride());
    const auto rows = static_cast<std::size_t>(size_px_.y);
    values_ = std::make_unique_for_overwrite<std::uint16_t[]>(stride * (rows + kSpareRows));
    linearise(image, linear15_from_srgb8_table(), alpha, {values_.get(), channel_stride_});
    std::fill_n(values_.get() + rows * stride, kSpareRows * stride, std::uint16_t{0});
}

const SrgbParabolas& srgb_parabolas() {
    static const SrgbParabolas parabolas = [] {
        SrgbParabolas made;
        for (std::size_t entry = 0; entry < 32; ++entry) {
            const double octave = std::ldexp(0.5, static_cast<int>(entry / 2));
            const double low = octave * static_cast<double>(2 + entry % 2);
            const Parabola parabola = parabola_between(low, low + octave);
            made.constant[entry] = static_cast<float>(parabola[0]);
            made.first[entry] = static_cast<float>(parabola[1]);
            made.second[entry] = static_cast<float>(parabola[2]);
        }
        return made;
    }();
    return parabolas;
}

const std::array<std::uint8_t, kLinearOne + 1>& srgb8_from_linear15_table() {
    static const std::array<std::uint8_t, kLinearOne + 1> table = [] {
        std::array<std::uint8_t, kLinearOne + 1> made{};
        for (std::size_t i = 0; i < made.size(); ++i) {
            made[i] = srgb8_from_linear15(static_cast<std::int32_t>(i), srgb_parabolas());
        }
        return made;
    }();
    return table;
}

}  // namespace lw
