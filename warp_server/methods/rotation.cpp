/// The homography of the head's rotation, bilinear: asynchronous timewarp. Blind to translation and to movers.

#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"

namespace lw {
namespace {

class RotationMethod final : public WarpMethod {
public:
    explicit RotationMethod(std::string label) : label_{std::move(label)} {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return prepare_picture(layer);
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        resample_by_rotation(layer, label_, target.camera, out, counters_);
    }

private:
    std::string label_;
};

}  // namespace

MadeMethod make_rotation_method(std::string label, const MethodSettings& /*settings*/) {
    return std::unique_ptr<WarpMethod>{std::make_unique<RotationMethod>(std::move(label))};
}

}  // namespace lw
