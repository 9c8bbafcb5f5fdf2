#include "apps/replay_truth.h"

namespace lw {

void ReplayTruth::draw(SceneRenderer& renderer, const Camera& camera, double photon_s) {
    camera_ = camera;
    renderer.draw(camera, photon_s, pixels_);
    renderer.mover_placements(photon_s, movers_);
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
