#pragma once
/// What a replay knows of a display frame and no warp method does: depth, ids and colour of the truth at pixel centres.

#include <cstdint>
#include <vector>

#include "client_renderer/scene_renderer.h"
#include "core/camera.h"
#include "core/error_attribution.h"
#include "core/flicker.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/warp_method.h"

namespace lw {

/// The scene at one photon time, one sample per pixel: the `fresh` baseline's picture, and the oracle of error figures.
class ReplayTruth {
public:
    /// Draws it. One thread, the renderer's.
    void draw(SceneRenderer& renderer, const Camera& camera, double photon_s);

    [[nodiscard]] const ColourImage& colour() const { return pixels_.colour; }
    [[nodiscard]] const std::vector<ObjectTransform>& movers() const { return movers_; }

    /// Share of the pixels that a source pixel reached but whose depth says that it lies behind what should be seen:
    /// farther, by a fifth, than all truth within a pixel.
    [[nodiscard]] double share_shown_behind(const DisplayFrame& shown) const;

    /// Why a method that warps `source` errs, pixel by pixel. Any thread.
    [[nodiscard]] Image<ErrorCause> causes(const Layer& source, int threads) const;
    /// Where each pixel's surface was in an earlier truth. Any thread.
    [[nodiscard]] Image<int> pixels_in(const ReplayTruth& before, int threads) const;
    /// Refers to this object.
    [[nodiscard]] SampledView view() const { return {camera_, pixels_.depth, pixels_.object_id, movers_}; }

private:
    Camera camera_;
    CpuPixels pixels_;
    std::vector<ObjectTransform> movers_;
};

}  // namespace lw
