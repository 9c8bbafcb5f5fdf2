#include "apps/replay_truth.h"

#include <algorithm>

namespace lw {

void ReplayTruth::draw(SceneRenderer& renderer, const Camera& camera, double photon_s) {
    camera_ = camera;
    renderer.draw(camera, photon_s, pixels_);
    renderer.mover_placements(photon_s, movers_);
}

double ReplayTruth::share_shown_behind(const DisplayFrame& shown) const {
    constexpr float kBehind = 0.8F;
    const glm::ivec2 last = pixels_.depth.size_px() - 1;
    std::size_t behind = 0;
    for (int y = 0; y <= last.y; ++y) {
        for (int x = 0; x <= last.x; ++x) {
            if (shown.coverage.at(x, y) != Coverage::reached) continue;
            float farthest = 1.0F;
            for (int v = std::max(y - 1, 0); v <= std::min(y + 1, last.y); ++v) {
                for (int u = std::max(x - 1, 0); u <= std::min(x + 1, last.x); ++u) {
                    farthest = std::min(farthest, pixels_.depth.at(u, v));
                }
            }
            behind += shown.depth.at(x, y) < kBehind * farthest ? 1 : 0;
        }
    }
    return static_cast<double>(behind) / static_cast<double>(pixels_.depth.pixels().size());
}

Image<ErrorCause> ReplayTruth::causes(const Layer& source, int threads) const {
    const CpuPixels& pixels = source.cpu();
    return error_causes(view(), pixels_.colour, {source.camera, pixels.depth, pixels.object_id, source.movers},
                        pixels.colour, threads);
}

Image<int> ReplayTruth::pixels_in(const ReplayTruth& before, int threads) const {
    return pixels_before(view(), before.view(), threads);
}

}  // namespace lw
