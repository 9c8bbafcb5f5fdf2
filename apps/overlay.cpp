#include "apps/overlay.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/bitmap_font.h"

namespace lw {
namespace {

constexpr Rgba8 kPaper{20, 20, 24, 255};
constexpr Rgba8 kInk{240, 240, 240, 255};
constexpr Rgba8 kGood{90, 190, 120, 255};
constexpr Rgba8 kBad{225, 90, 80, 255};
constexpr Rgba8 kMark{250, 220, 120, 255};
constexpr int kLetterPitch = kGlyphWidthPx + 1;
constexpr int kLinePitch = kGlyphHeightPx + 4;
constexpr int kMargin = 3;
constexpr int kLabelLetters = 17;
constexpr int kValueLetters = 9;

void draw_text(ColourImage& image, glm::ivec2 corner_px, int scale, const std::string& text) {
    int x_px = corner_px.x;
    for (const char letter : text) {
        if (x_px + kGlyphWidthPx * scale > image.width()) return;
        const GlyphRows& rows = glyph_of(letter);
        for (int y = 0; y < kGlyphHeightPx * scale; ++y) {
            for (int x = 0; x < kGlyphWidthPx * scale; ++x) {
                const int bit = kGlyphWidthPx - 1 - x / scale;
                const bool inked = (rows[static_cast<std::size_t>(y / scale)] >> bit & 1) != 0;
                if (inked) image.at(x_px + x, corner_px.y + y) = kInk;
            }
        }
        x_px += kLetterPitch * scale;
    }
}

void fill(ColourImage& image, glm::ivec2 from_px, glm::ivec2 to_px, Rgba8 colour) {
    for (int y = std::max(0, from_px.y); y < std::min(image.height(), to_px.y); ++y) {
        for (int x = std::max(0, from_px.x); x < std::min(image.width(), to_px.x); ++x) image.at(x, y) = colour;
    }
}

ColourImage paper(std::size_t lines, int width_px, int scale) {
    return ColourImage{{width_px, (static_cast<int>(lines) * kLinePitch + kMargin) * scale}, kPaper};
}

glm::ivec2 line_corner(std::size_t line, int scale) {
    return {kMargin * scale, (kMargin + static_cast<int>(line) * kLinePitch) * scale};
}

}  // namespace

ColourImage text_panel(const std::vector<std::string>& lines, int width_px, int scale) {
    ColourImage panel = paper(lines.size(), width_px, scale);
    for (std::size_t i = 0; i < lines.size(); ++i) draw_text(panel, line_corner(i, scale), scale, lines[i]);
    return panel;
}

ColourImage bar_panel(const std::vector<OverlayBar>& bars, int width_px, int scale) {
    ColourImage panel = paper(bars.size(), width_px, scale);
    const int left_px = (kMargin + kLabelLetters * kLetterPitch) * scale;
    const int right_px = width_px - (kMargin + kValueLetters * kLetterPitch) * scale;
    const auto x_of = [&](const OverlayBar& bar, double value) {
        const double share = std::clamp(value / std::max(bar.full, 1e-9), 0.0, 1.0);
        return left_px + static_cast<int>(share * (right_px - left_px));
    };
    for (std::size_t i = 0; i < bars.size(); ++i) {
        const OverlayBar& bar = bars[i];
        const glm::ivec2 corner_px = line_corner(i, scale);
        const int bottom_px = corner_px.y + kGlyphHeightPx * scale;
        draw_text(panel, corner_px, scale, bar.label);
        const bool beyond = bar.target > 0.0 && bar.value > bar.target;
        fill(panel, {left_px, corner_px.y}, {x_of(bar, bar.value), bottom_px}, beyond ? kBad : kGood);
        if (bar.target > 0.0) {
            const int x_px = x_of(bar, bar.target);
            fill(panel, {x_px, corner_px.y - scale}, {x_px + scale, bottom_px + scale}, kMark);
        }
        draw_text(panel, {right_px + 2 * scale, corner_px.y}, scale, fmt::format("{:.1f} {}", bar.value, bar.unit));
    }
    return panel;
}

}  // namespace lw
