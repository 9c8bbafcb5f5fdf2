/// The newest frame unwarped: what a user sees without a warp server. Only a difference of field of view or size is
/// undone, so that a guard band does not shrink the picture. What a frame keeps of older pictures is turned to its
/// view.

#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"

namespace lw {
namespace {

class StaleMethod final : public WarpMethod {
public:
    explicit StaleMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] bool shows_frames_as_drawn() const override { return true; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return prepare_picture(layer);
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        Camera unturned = target.camera;
        unturned.world_from_eye = layer.camera.world_from_eye;
        resample_by_rotation(layer, label_, unturned, out, counters_);
    }

private:
    std::string label_;
};

}  // namespace

MadeMethod make_stale_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<StaleMethod>(std::move(label))};
}

}  // namespace lw
