#pragma once
/// What an encoded image claims to be, before a decoder allocates for it.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>

namespace lw::scene {

struct EncodedImage {
    glm::ivec2 size_px{0};
    int decode_bytes_per_px = 0;  ///< most memory that decoding to RGBA8 holds besides its result, per pixel
};

/// Reads the header of a PNG (IHDR) or JPEG (first SOF marker). Nothing for other formats and cut headers.
[[nodiscard]] std::optional<EncodedImage> peek_image(std::span<const std::uint8_t> bytes);

}  // namespace lw::scene
