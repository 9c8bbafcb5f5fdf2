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

}  // namespace lw
