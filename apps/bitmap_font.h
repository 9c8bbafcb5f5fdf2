#pragma once
/// A 5x7 bitmap font of capitals, digits and the punctuation of labels.

#include <array>
#include <cstdint>

namespace lw {

inline constexpr int kGlyphWidthPx = 5;
inline constexpr int kGlyphHeightPx = 7;

/// Rows from the top; bit 4 is the leftmost pixel.
using GlyphRows = std::array<std::uint8_t, kGlyphHeightPx>;

/// The shape of a letter, small ones as capitals; blank for what the font does not hold. Pure, any thread.
[[nodiscard]] const GlyphRows& glyph_of(char letter);

}  // namespace lw
