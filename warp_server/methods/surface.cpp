/// The default: the source is cut into pieces of plane (large blocks, and single cells along edges); each piece is laid
/// over the target, where every pixel in it asks for its exact place in the source and reads the colour there.

#include <algorithm>

#include "warp_server/band_pool.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_kernels.h"
#include "warp_server/methods/surface_split.h"

namespace lw {
namespace {

// Draws one band of rows of the target; one per thread.
class BandPainter {
public:
    void paint(const PatchInput& input, RowRange band, DisplayFrame& out) {
        canvas_.begin(out, band);
        draw_list(input, input.prepared->blocks);
        draw_list(input, input.prepared->patches);
        draw_list(input, input.prepared->edges);
        canvas_.finish();
    }

private:
    // Patches that reach behind the target eye are cut until their parts are before it, or are single cells.
    void draw_list(const PatchInput& input, const PatchList& list) {
        behind_.clear();
        draw_patches(input, list, canvas_, behind_);
        if (behind_.empty()) return;
        parts_.clear();
        for (const std::uint32_t index : behind_) split_patch(list, index, parts_);
        while (parts_.size() > 0) {
            behind_.clear();
            draw_patches(input, parts_, canvas_, behind_);
            smaller_parts_.clear();
            for (const std::uint32_t index : behind_) split_patch(parts_, index, smaller_parts_);
            std::swap(parts_, smaller_parts_);
        }
    }

    SurfaceCanvas canvas_;
    std::vector<std::uint32_t> behind_;
    PatchList parts_;
    PatchList smaller_parts_;
};

class SurfaceMethod final : public WarpMethod {
public:
    SurfaceMethod(std::string label, int threads)
        : label_{std::move(label)}, pool_{threads}, painters_(static_cast<std::size_t>(threads)) {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return classify_surfaces(checked_cpu_pixels(layer));
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        std::shared_ptr<const PreparedLayer> own;
        const PreparedLayer* prepared = layer.prepared_for(label_);
        if (prepared == nullptr) {
            own = prepare(layer);
            prepared = own.get();
        }
        input_ = {static_cast<const PreparedSurface*>(prepared), &matrices_};
        matrices_.build(layer, target);
        count_bad_pixels(*input_.prepared);
        out.resize(target.camera.size_px);
        if (matrices_.all_identity()) {
            copy_source(pixels, out);
            return;
        }
        out_ = &out;
        pool_.run(paint_band_);
    }

private:
    void count_bad_pixels(const PreparedSurface& prepared) {
        counters_ = {};
        for (const IdCount& count : prepared.id_counts) {
            if (matrices_.find(count.id) == nullptr) {
                counters_.unknown_object += count.pixels;
            } else {
                counters_.bad_depth += count.bad_depths;
            }
        }
    }

    // Nothing moves: the source, bit for bit.
    void copy_source(const CpuPixels& pixels, DisplayFrame& out) const {
        std::copy(pixels.colour.pixels().begin(), pixels.colour.pixels().end(), out.colour.pixels().begin());
        std::copy(pixels.depth.pixels().begin(), pixels.depth.pixels().end(), out.depth.pixels().begin());
        const std::span<Coverage> coverage = out.coverage.pixels();
        std::fill(coverage.begin(), coverage.end(), Coverage::reached);
        if (counters_.bad_depth == 0 && counters_.unknown_object == 0) return;
        for (std::size_t i = 0; i < coverage.size(); ++i) {
            const bool usable =
                is_usable_depth(pixels.depth.pixels()[i]) && matrices_.find(pixels.object_id.pixels()[i]) != nullptr;
            if (!usable) coverage[i] = Coverage::hole;
        }
    }

    std::string label_;
    BandPool pool_;
    std::vector<BandPainter> painters_;
    ObjectMatrices matrices_;
    PatchInput input_;
    DisplayFrame* out_ = nullptr;
    // Kept, because making a function object may allocate.
    std::function<void(int)> paint_band_ = [this](int thread) {
        const RowRange band = band_of_rows(out_->colour.height(), thread, pool_.threads());
        painters_[static_cast<std::size_t>(thread)].paint(input_, band, *out_);
    };
};

}  // namespace

MadeMethod make_surface_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SurfaceMethod>(std::move(label), *threads)};
}

}  // namespace lw
