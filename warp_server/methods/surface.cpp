/// The default: the source is cut into pieces of plane (large blocks, and single cells along edges); each piece is laid
/// over the target, where every pixel in it asks for its exact place in the source and reads the colour there.

#include <algorithm>
#include <cmath>

#include "warp_server/band_pool.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
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
        draw_tile_list(input);
        draw_list(input, input.prepared->edges);
        canvas_.finish();
    }

    /// Of the last picture.
    [[nodiscard]] const SurfaceSkips& skips() const { return canvas_.skips(); }

private:
    // Patches that reach behind the target eye are cut until their parts are before it, or are single cells.
    void draw_list(const PatchInput& input, const PatchList& list) {
        behind_.clear();
        draw_patches(input, list, canvas_, behind_);
        if (behind_.empty()) return;
        parts_.clear();
        for (const std::uint32_t index : behind_) split_patch(list, index, parts_);
        draw_parts(input);
    }

    void draw_tile_list(const PatchInput& input) {
        behind_.clear();
        draw_tiles(input, canvas_, behind_);
        if (behind_.empty()) return;
        parts_.clear();
        edge_parts_.clear();
        for (const std::uint32_t index : behind_) split_tile(input.prepared->tiles, index, parts_, edge_parts_);
        draw_parts(input);
        std::swap(parts_, edge_parts_);
        draw_parts(input);
    }

    void draw_parts(const PatchInput& input) {
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
    PatchList edge_parts_;
};

class SurfaceMethod final : public WarpMethod {
public:
    SurfaceMethod(std::string label, int threads)
        : label_{std::move(label)},
          pool_{threads},
          painters_(static_cast<std::size_t>(threads)),
          bands_(static_cast<std::size_t>(threads)) {}

    [[nodiscard]] std::string_view label() const override { return label_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return classify_surfaces(checked_cpu_pixels(layer));
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        std::shared_ptr<const PreparedLayer> own;
        input_ = {&prepared_or_made<PreparedSurface>(layer, own), &matrices_};
        matrices_.build(layer, target);
        counters_ = bad_pixels(input_.prepared->id_counts, matrices_);
        out.resize(target.camera.size_px);
        if (matrices_.all_identity()) {
            copy_source(pixels, out);
            return;
        }
        out_ = &out;
        place_bands(layer.camera, target.camera);
        pool_.run(paint_band_);
        for (const BandPainter& painter : painters_) {
            counters_.tiles_empty += painter.skips().empty;
            counters_.tiles_outside += painter.skips().outside;
            counters_.tiles_hidden += painter.skips().hidden;
        }
    }

private:
    // Bands of the source that cost the same, moved to where their middles land when the head only turns: near enough
    // for sharing work, and the picture does not depend on it.
    void place_bands(const Camera& source, const Camera& target) {
        const int threads = pool_.threads();
        const glm::mat3 source_from_target = background_source_from_target(source, target);
        const glm::mat3 target_from_source = glm::inverse(source_from_target);
        const int height = target.size_px.y;
        for (int i = 0; i < threads; ++i) {
            const RowRange rows = band_of_cost(input_.prepared->cost_until, i, threads);
            const glm::vec3 place = target_from_source * glm::vec3{0.5F * static_cast<float>(source.size_px.x),
                                                                   static_cast<float>(rows.end), 1.0F};
            const bool usable = place.z > 0.0F && std::abs(place.y) < 1e6F * place.z;
            const int previous = i == 0 ? 0 : bands_[static_cast<std::size_t>(i) - 1].end;
            const int end = usable ? std::clamp(static_cast<int>(place.y / place.z), previous, height) : previous;
            bands_[static_cast<std::size_t>(i)] = {previous, i + 1 == threads ? height : end};
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
    std::vector<RowRange> bands_;
    ObjectMatrices matrices_;
    PatchInput input_;
    DisplayFrame* out_ = nullptr;
    // Kept, because making a function object may allocate.
    std::function<void(int)> paint_band_ = [this](int thread) {
        painters_[static_cast<std::size_t>(thread)].paint(input_, bands_[static_cast<std::size_t>(thread)], *out_);
    };
};

}  // namespace

MadeMethod make_surface_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SurfaceMethod>(std::move(label), *threads)};
}

}  // namespace lw
