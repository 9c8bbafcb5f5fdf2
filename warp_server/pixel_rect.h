#pragma once
/// A part of a picture.

#include <glm/glm.hpp>

namespace lw {

/// Columns and rows of a picture: [first, end).
struct PixelRect {
    glm::ivec2 first_px{0};
    glm::ivec2 end_px{0};

    [[nodiscard]] bool empty() const { return first_px.x >= end_px.x || first_px.y >= end_px.y; }
    [[nodiscard]] glm::ivec2 size_px() const { return end_px - first_px; }
};

/// What two parts share; empty when nothing.
[[nodiscard]] inline PixelRect common(const PixelRect& a, const PixelRect& b) {
    return {glm::max(a.first_px, b.first_px), glm::min(a.end_px, b.end_px)};
}

}  // namespace lw
