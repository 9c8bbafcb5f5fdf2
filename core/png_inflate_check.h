#pragma once
/// Guards against PNG files whose compressed data holds far more than their picture.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

namespace lw {

/// Whether the pixel data of a PNG inflates to no more than a picture of its size can need (stb inflates whatever there
/// is: 1 MB of zeros squeezed a thousandfold became 960 MB resident). Inflates into a bounded buffer only where the
/// data could be that large; small files and other formats pass at once. Any thread.
/// @param size_px  as the header says, already checked
[[nodiscard]] bool png_data_fits(std::span<const std::uint8_t> png, glm::ivec2 size_px);

}  // namespace lw
