#pragma once
/// sRGB encoding (IEC 61966-2-1). Colour is stored encoded, and filtered, averaged and lit in linear light.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "core/image.h"

namespace lw {

/// Linear light of an sRGB value, both in [0, 1]. Pure, any thread.
[[nodiscard]] double linear_from_srgb(double srgb);
[[nodiscard]] double srgb_from_linear(double linear);

/// Linear light of each of the 256 stored values. Built once, thread safe.
[[nodiscard]] const std::array<float, 256>& linear_from_srgb8_table();

/// Nearest stored value of a linear one; clamps to [0, 1], NaN becomes 0. round-trips every stored value. Any thread.
[[nodiscard]] std::uint8_t srgb8_from_linear(float linear);

[[nodiscard]] glm::vec3 linear_of(Rgba8 colour);
[[nodiscard]] Rgba8 srgb8_of(const glm::vec3& linear);

}  // namespace lw
