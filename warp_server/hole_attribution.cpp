#include "warp_server/hole_attribution.h"

#include "warp_server/methods/homography_resample.h"

namespace lw {
namespace {

constexpr int kStepPx = 2;

std::vector<glm::vec3> holes_of(const DisplayFrame& shown) {
    std::vector<glm::vec3> holes;
    for (int y = 0; y < shown.coverage.height(); y += kStepPx) {
        for (int x = 0; x < shown.coverage.width(); x += kStepPx) {
            if (shown.coverage.at(x, y) == Coverage::reached) continue;
            holes.emplace_back(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F, 1.0F);
        }
    }
    return holes;
}

}  // namespace

void attribute_holes(const DisplayFrame& shown, const RenderedFrame& frame, const Camera& target,
                     HoleFeedback& feedback) {
    ++feedback.display_frames;
    const std::vector<glm::vec3> holes = holes_of(shown);
    if (holes.empty()) return;
    for (const auto& layer : frame.layers) {
        const glm::mat3 source_from_target = background_source_from_target(layer->camera, target);
        const glm::vec2 size_px{layer->camera.size_px};
        std::uint32_t inside = 0;
        for (const glm::vec3& hole : holes) {
            const glm::vec3 h = source_from_target * hole;
            if (h.z > 0.0F && h.x >= 0.0F && h.y >= 0.0F && h.x < size_px.x * h.z && h.y < size_px.y * h.z) ++inside;
        }
        if (inside > 0) feedback.add(layer->content.item, inside * kStepPx * kStepPx);
    }
}

}  // namespace lw
