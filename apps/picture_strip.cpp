#include "apps/picture_strip.h"

#include <algorithm>

#include "apps/bitmap_font.h"
#include "core/check.h"

namespace lw {

namespace {

constexpr Rgba8 kPaper{255, 255, 255, 255};
constexpr Rgba8 kInk{24, 24, 24, 255};
constexpr int kLettersPerPicture = 24;
constexpr int kLetterPitch = kGlyphWidthPx + 1;  ///< glyph pixels, one of them empty
constexpr int kLinePitch = kGlyphHeightPx + 3;

void draw_glyph(ColourImage& image, glm::ivec2 corner_px, int scale, char letter) {
    const GlyphRows& rows = glyph_of(letter);
    for (int y = 0; y < kGlyphHeightPx * scale; ++y) {
        for (int x = 0; x < kGlyphWidthPx * scale; ++x) {
            const int bit = kGlyphWidthPx - 1 - x / scale;
            if (((rows[static_cast<std::size_t>(y / scale)] >> bit) & 1) != 0) {
                image.at(corner_px.x + x, corner_px.y + y) = kInk;
            }
        }
    }
}

void draw_line(ColourImage& image, glm::ivec2 corner_px, int width_px, int scale, const std::string& line) {
    const int room = width_px / (kLetterPitch * scale);
    const int count = std::min(room, static_cast<int>(line.size()));
    for (int i = 0; i < count; ++i) {
        draw_glyph(image, {corner_px.x + i * kLetterPitch * scale, corner_px.y}, scale,
                   line[static_cast<std::size_t>(i)]);
    }
}

void copy_picture(const ColourImage& picture, ColourImage& strip, glm::ivec2 corner_px) {
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            Rgba8 colour = picture.at(x, y);
            colour.a = 255;
            strip.at(corner_px.x + x, corner_px.y + y) = colour;
        }
    }
}

}  // namespace

ColourImage picture_strip(const std::vector<StripPicture>& pictures) {
    LW_CHECK(!pictures.empty(), "a strip of no pictures");
    const glm::ivec2 size_px = pictures.front().picture->size_px();
    const int scale = std::max(1, size_px.x / (kLettersPerPicture * kLetterPitch));
    const int gap_px = 4 * scale;
    std::size_t line_count = 0;
    for (const StripPicture& entry : pictures) {
        LW_CHECK(entry.picture->size_px() == size_px, "the pictures of a strip have one size");
        line_count = std::max(line_count, entry.lines.size());
    }
    const int count = static_cast<int>(pictures.size());
    const int text_height_px = static_cast<int>(line_count) * kLinePitch * scale;
    ColourImage strip{{count * size_px.x + (count + 1) * gap_px, size_px.y + 2 * gap_px + text_height_px}, kPaper};
    for (int i = 0; i < count; ++i) {
        const StripPicture& entry = pictures[static_cast<std::size_t>(i)];
        const glm::ivec2 corner_px{gap_px + i * (size_px.x + gap_px), gap_px};
        copy_picture(*entry.picture, strip, corner_px);
        for (std::size_t line = 0; line < entry.lines.size(); ++line) {
            const int y_px = corner_px.y + size_px.y + gap_px + static_cast<int>(line) * kLinePitch * scale;
            draw_line(strip, {corner_px.x, y_px}, size_px.x, scale, entry.lines[line]);
        }
    }
    return strip;
}

}  // namespace lw
