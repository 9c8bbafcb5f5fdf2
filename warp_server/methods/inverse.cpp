/// For each target pixel a fixed-point search for the source place that lands on it: s += p - q(s). The published
/// alternative to splatting: sharp and cheap for small parallax, lost at large parallax and on thin things.

#include <functional>

#include "core/task_pool.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/methods/id_counts.h"
#include "warp_server/methods/inverse_kernels.h"
#include "warp_server/methods/linear_colour.h"
#include "warp_server/methods/object_matrices.h"

namespace lw {
namespace {

// Bands of a picture differ in cost, and threads start at different times.
constexpr int kBandsPerThread = 4;

struct PreparedInverse final : PreparedLayer {
    LinearImage linear;
    std::vector<IdCount> id_counts;
};

class InverseMethod final : public WarpMethod {
public:
    InverseMethod(std::string label, int steps, int threads)
        : label_{std::move(label)}, pool_{threads}, steps_{steps} {}

    [[nodiscard]] std::string_view label() const override { return label_; }
    [[nodiscard]] TaskPool* threads() override { return &pool_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        auto prepared = std::make_shared<PreparedInverse>();
        prepared->linear = LinearImage{pixels.colour};
        prepared->id_counts = count_ids(pixels);
        return prepared;
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        std::shared_ptr<const PreparedLayer> own;
        const auto& prepared = prepared_or_made<PreparedInverse>(layer, own);
        matrices_.build(layer, target, 1.0F, &pool_);
        counters_ = bad_pixels(prepared.id_counts, matrices_);
        out.resize(target.camera.size_px);
        input_ = {&checked_cpu_pixels(layer), &prepared.linear, &matrices_,
                  background_source_from_target(layer.camera, target.camera), steps_};
        out_ = &out;
        bands_ = kBandsPerThread * pool_.threads();
        pool_.run(bands_, search_band_);
    }

private:
    std::string label_;
    TaskPool pool_;
    int steps_;
    ObjectMatrices matrices_;
    InverseInput input_;
    DisplayFrame* out_ = nullptr;
    int bands_ = 1;
    // Kept, because making a function object may allocate.
    TaskPool::Work search_band_ = [this](int band, int /*worker*/) {
        search_rows(input_, band_of_rows(out_->depth.height(), band, bands_), *out_);
    };
};

}  // namespace

MadeMethod make_inverse_method(std::string label, const MethodSettings& settings) {
    const Result<int> steps = whole_setting(label, settings, "steps", 3, 1, 8);
    if (!steps) return steps.error();
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<InverseMethod>(std::move(label), *steps, *threads)};
}

}  // namespace lw
