#pragma once
/// Textures made by code: sRGB, tileable, with detail at every scale so that each mip level has something to show.

#include "core/image.h"

namespace lw::scene {

[[nodiscard]] ColourImage plaster_texture();
[[nodiscard]] ColourImage brick_texture();
[[nodiscard]] ColourImage stone_texture();
[[nodiscard]] ColourImage roof_tile_texture();  ///< 8 x 8 tiles
[[nodiscard]] ColourImage roof_felt_texture();
[[nodiscard]] ColourImage wood_texture();
[[nodiscard]] ColourImage asphalt_texture();
[[nodiscard]] ColourImage paving_texture();  ///< 6 x 6 slabs
[[nodiscard]] ColourImage grass_texture();
[[nodiscard]] ColourImage bark_texture();

}  // namespace lw::scene
