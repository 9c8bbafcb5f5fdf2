#pragma once
/// Bilinear reads of sRGB images in linear light.

#include <algorithm>
#include <array>
#include <cmath>

#include "core/colour.h"
#include "core/image.h"

namespace lw {

/// The four pixels around a place and its fractions between them, clamped to the image.
struct BilinearTap {
    int x0 = 0;
    int y0 = 0;
    int x1 = 0;
    int y1 = 0;
    float fx = 0.0F;  ///< 0 at column x0, 1 at x1
    float fy = 0.0F;
};

/// `x_px`, `y_px` in pixels with centres at +0.5; finite.
[[nodiscard]] inline BilinearTap bilinear_tap(float x_px, float y_px, glm::ivec2 size_px) {
    const float x = std::clamp(x_px - 0.5F, 0.0F, static_cast<float>(size_px.x - 1));
    const float y = std::clamp(y_px - 0.5F, 0.0F, static_cast<float>(size_px.y - 1));
    BilinearTap tap;
    tap.x0 = static_cast<int>(x);
    tap.y0 = static_cast<int>(y);
    tap.x1 = std::min(tap.x0 + 1, size_px.x - 1);
    tap.y1 = std::min(tap.y0 + 1, size_px.y - 1);
    tap.fx = x - static_cast<float>(tap.x0);
    tap.fy = y - static_cast<float>(tap.y0);
    return tap;
}

/// Colour at the tap, opaque. Exactly the stored colour where both fractions are 0.
[[nodiscard]] inline Rgba8 sample_bilinear(const ColourImage& image, const BilinearTap& tap) {
    const Rgba8 c00 = image.at(tap.x0, tap.y0);
    if (tap.fx == 0.0F && tap.fy == 0.0F) return opaque(c00);
    const Rgba8 c10 = image.at(tap.x1, tap.y0);
    const Rgba8 c01 = image.at(tap.x0, tap.y1);
    const Rgba8 c11 = image.at(tap.x1, tap.y1);
    if (c00 == c10 && c00 == c01 && c00 == c11) return opaque(c00);
    const std::array<float, 256>& linear = linear_from_srgb8_table();
    const auto mix = [&](std::uint8_t Rgba8::*channel) {
        const float top = linear[c00.*channel] + tap.fx * (linear[c10.*channel] - linear[c00.*channel]);
        const float bottom = linear[c01.*channel] + tap.fx * (linear[c11.*channel] - linear[c01.*channel]);
        return srgb8_from_linear(top + tap.fy * (bottom - top));
    };
    return {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), 255};
}

}  // namespace lw
