/// Every source pixel is a point, moved by its object's matrix; the winner rule decides each target pixel.

#include <algorithm>

#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_kernels.h"

namespace lw {
namespace {

class SplatMethod final : public WarpMethod {
public:
    explicit SplatMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        matrices_.build(layer, target);
        out.resize(target.camera.size_px);
        clear_keys_of(target.camera.size_px);
        const SplatInput input{&pixels, &matrices_};
        splat_points(input, {0, pixels.depth.height()}, keys_, counters_);
        const BackgroundLookup background{background_source_from_target(layer.camera, target.camera)};
        resolve_keys(input, background, {0, keys_.height()}, keys_, out);
    }

private:
    // Resolving leaves the keys cleared, so only a new size needs it done here.
    void clear_keys_of(glm::ivec2 size_px) {
        if (keys_.size_px() == size_px) return;
        keys_.resize(size_px);
        std::fill(keys_.pixels().begin(), keys_.pixels().end(), WinnerKey{0});
    }

    std::string label_;
    ObjectMatrices matrices_;
    Image<WinnerKey> keys_;
};

}  // namespace

MadeMethod make_splat_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<SplatMethod>(std::move(label))};
}

}  // namespace lw
