/// Every source pixel is a point, moved by its object's matrix; the winner rule decides each target pixel.

#include <algorithm>

#include "warp_server/band_pool.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_kernels.h"

namespace lw {
namespace {

// Threads share the source by rows, and each has keys of its own, so that no two write to one place. The larger key
// wins whoever wrote it, so the picture does not depend on the number of threads.
class SplatMethod final : public WarpMethod {
public:
    SplatMethod(std::string label, int threads)
        : label_{std::move(label)}, pool_{threads}, shares_(static_cast<std::size_t>(threads)) {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        counters_ = {};
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        matrices_.build(layer, target);
        out.resize(target.camera.size_px);
        input_ = {&pixels, &matrices_};
        background_ = {background_source_from_target(layer.camera, target.camera)};
        out_ = &out;
        if (pool_.threads() > 1) estimate_costs(pixels.depth);
        pool_.run(splat_share_);
        for (const Share& share : shares_) {
            counters_.bad_depth += share.counters.bad_depth;
            counters_.unknown_object += share.counters.unknown_object;
        }
        pool_.run(resolve_band_);
    }

private:
    struct Share {
        Image<WinnerKey> keys;
        RowRange written;  // rows of keys that are not all 0
        WarpCounters counters;
    };

    // Points cost, background does not: counts them in a sample of the pixels.
    void estimate_costs(const DepthImage& depth) {
        constexpr int kRowStep = 8;
        constexpr int kColumnStep = 16;
        cost_until_.assign(static_cast<std::size_t>(depth.height()) + 1, 0.0F);
        float row_cost = 0.0F;
        for (int y = 0; y < depth.height(); ++y) {
            if (y % kRowStep == 0) {
                row_cost = 0.1F;  // looking at background costs a little, too
                for (int x = kColumnStep / 2; x < depth.width(); x += kColumnStep)
                    row_cost += depth.at(x, y) > 0.0F ? 1.0F : 0.0F;
            }
            cost_until_[static_cast<std::size_t>(y) + 1] = cost_until_[static_cast<std::size_t>(y)] + row_cost;
        }
    }

    void splat_share(int thread) {
        Share& share = shares_[static_cast<std::size_t>(thread)];
        if (share.keys.size_px() != out_->colour.size_px()) {  // else resolving left them cleared
            share.keys.resize(out_->colour.size_px());
            std::fill(share.keys.pixels().begin(), share.keys.pixels().end(), WinnerKey{0});
        }
        share.counters = {};
        const int height = input_.pixels->depth.height();
        const RowRange rows =
            pool_.threads() == 1 ? RowRange{0, height} : band_of_cost(cost_until_, thread, pool_.threads());
        share.written = splat_points(input_, rows, share.keys, share.counters);
    }

    void resolve_band(int thread) {
        const RowRange band = band_of_rows(out_->colour.height(), thread, pool_.threads());
        Share& first = shares_.front();
        for (std::size_t i = 1; i < shares_.size(); ++i) {
            const RowRange rows{std::max(band.begin, shares_[i].written.begin),
                                std::min(band.end, shares_[i].written.end)};
            if (rows.begin < rows.end) merge_keys(rows, shares_[i].keys, first.keys);
        }
        resolve_keys(input_, background_, band, first.keys, *out_);
    }

    std::string label_;
    BandPool pool_;
    std::vector<Share> shares_;
    ObjectMatrices matrices_;
    SplatInput input_;
    BackgroundLookup background_;
    DisplayFrame* out_ = nullptr;
    std::vector<float> cost_until_;
    // Kept, because making a function object may allocate.
    std::function<void(int)> splat_share_ = [this](int thread) { splat_share(thread); };
    std::function<void(int)> resolve_band_ = [this](int thread) { resolve_band(thread); };
};

}  // namespace

MadeMethod make_splat_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SplatMethod>(std::move(label), *threads)};
}

}  // namespace lw
