#pragma once
/// What the demo writes over its picture: a help line, and the latencies of the moment as bars.

#include <string>
#include <vector>

#include "core/image.h"

namespace lw {

/// An opaque rectangle over the display frame, its top-left corner at `corner_px`.
struct OverlayPanel {
    ColourImage picture;
    glm::ivec2 corner_px{0};
};

/// One bar: `value` of `full`, with a mark at `target` if that is above zero.
struct OverlayBar {
    std::string label;
    double value = 0.0;
    double full = 1.0;
    double target = 0.0;
    std::string unit = "MS";
};

/// White letters on dark, one line per string. Letters of the built-in font (glyph_of()); lines that are too wide are
/// cut off. Pure, any thread.
[[nodiscard]] ColourImage text_panel(const std::vector<std::string>& lines, int width_px, int scale);

/// A line per bar: label, bar, value. A bar beyond its target is red. Pure, any thread.
[[nodiscard]] ColourImage bar_panel(const std::vector<OverlayBar>& bars, int width_px, int scale);

}  // namespace lw
