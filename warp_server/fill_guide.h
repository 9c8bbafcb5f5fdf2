#pragma once
/// What a fill may know of the motion that opened the holes.

#include <glm/glm.hpp>

#include "core/camera.h"

namespace lw {

/// Two cameras that see a static scene from different places: what the target sees and the source did not lies behind
/// something, seen along the line that joins the pixel and the picture of the source's eye (the epipolar line).
struct FillGuide {
    /// The source's eye as the target sees it, w * (x_px, y_px, 1) with w its distance along the target's -z axis,
    /// metres; w < 0 behind the target. Zero where both eyes are in one place: nothing is uncovered then.
    glm::dvec3 source_eye_target_px{0.0};

    /// Where along its epipolar line a hole at `position_px` has its background: away from what hid it in the source.
    /// A static thing at distance d moves by the result's length / d against what is infinitely far, px * m.
    [[nodiscard]] glm::dvec2 background_px_m(const glm::dvec2& position_px) const {
        return source_eye_target_px.z * position_px - glm::dvec2{source_eye_target_px};
    }
};

/// Pure, any thread.
[[nodiscard]] FillGuide fill_guide(const Camera& source, const Camera& target);

}  // namespace lw
