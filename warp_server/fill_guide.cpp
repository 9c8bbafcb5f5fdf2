#include "warp_server/fill_guide.h"

namespace lw {

FillGuide fill_guide(const Camera& source, const Camera& target) {
    // Subtracted before it is turned, so that eyes far from the origin lose nothing.
    const glm::dvec3 offset_world = source.world_from_eye.position_m - target.world_from_eye.position_m;
    const glm::dvec3 offset_eye = glm::conjugate(target.world_from_eye.orientation) * offset_world;
    const auto target_px_from_target_eye = target_px_from_target_clip(target) * target_clip_from_target_eye(target);
    const glm::dvec4 h = target_px_from_target_eye.matrix * glm::dvec4{offset_eye, 1.0};
    // As TargetPx says: w * (x_px, y_px, depth, 1).
    return {{h.x, h.y, h.w}};
}

}  // namespace lw
