#pragma once
/// Encodes PNG files (ISO/IEC 15948); stb, which reads them, cannot write 16-bit ones.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lw {

enum class PngColour : std::uint8_t { grey = 0, rgb = 2, rgba = 6 };

/// @param bits   per channel, 8 or 16
/// @param bytes  rows top first, samples big-endian, without padding
/// @return the file, or nothing when compression fails (out of memory). The same input gives the same bytes. Any
/// thread.
[[nodiscard]] std::vector<std::uint8_t> encode_png(glm::ivec2 size_px, PngColour colour, int bits,
                                                   std::span<const std::uint8_t> bytes);

}  // namespace lw
