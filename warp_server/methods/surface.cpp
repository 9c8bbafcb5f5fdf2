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

// A layer to be drawn, and where it shows anything.
struct PaintedLayer {
    PatchInput input;
    PixelRect reach;
    float nearest_depth = 1.0F;
};

// Draws one band of rows of the target; one per thread.
class BandPainter {
public:
    void paint(std::span<const PaintedLayer> layers, RowRange band, StackBase base, DisplayFrame& out) {
        canvas_.begin(out, band, base);
        bool is_empty = base == StackBase::nothing;
        for (const PaintedLayer& layer : layers) {
            if (!is_empty && !may_show(layer)) continue;
            draw(layer.input);
            if (layers.size() > 1) canvas_.finish_layer();
            is_empty = false;
        }
        canvas_.finish();
    }

    /// Of the last picture.
    [[nodiscard]] const SurfaceSkips& skips() const { return canvas_.skips(); }
    [[nodiscard]] const std::vector<PartlyCovered>& partly_covered() const { return canvas_.partly_covered(); }

private:
    // Is anything in the layer's reach empty, or farther than all of the layer?
    [[nodiscard]] bool may_show(const PaintedLayer& layer) const {
        const auto columns = static_cast<std::size_t>(std::max(layer.reach.size_px().x, 0));
        const int begin = std::max(layer.reach.first_px.y, canvas_.band().begin);
        const int end = std::min(layer.reach.end_px.y, canvas_.band().end);
        for (int y = begin; y < end; ++y) {
            const float* depths = canvas_.frame().depth.row(y).data() + layer.reach.first_px.x;
            if (count_below(depths, columns, layer.nearest_depth) > 0) return true;
        }
        return false;
    }

    void draw(const PatchInput& input) {
        SurfaceRegion begin;
        for (const SurfaceRegion& end : input.prepared->regions) {
            draw_list(input, input.prepared->blocks, {begin.blocks, end.blocks});
            draw_list(input, input.prepared->patches, {begin.patches, end.patches});
            draw_tile_list(input, {begin.tiles, end.tiles});
            draw_list(input, input.prepared->edges, {begin.edges, end.edges});
            begin = end;
        }
    }

    // Patches that reach behind the target eye are cut until their parts are before it, or are single cells.
    void draw_list(const PatchInput& input, const PatchList& list, ListRange range) {
        behind_.clear();
        draw_patches(input, list, range, canvas_, behind_);
        if (behind_.empty()) return;
        parts_.clear();
        for (const std::uint32_t index : behind_) split_patch(list, index, parts_);
        draw_parts(input);
    }

    void draw_tile_list(const PatchInput& input, ListRange range) {
        behind_.clear();
        draw_tiles(input, range, canvas_, behind_);
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
            draw_patches(input, parts_, {0, parts_.size()}, canvas_, behind_);
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
        const StackedLayer alone{&layer, 1.0F, {{0, 0}, target.camera.size_px}, 1.0F};
        warp_stack({&alone, 1}, target, StackBase::nothing, out);
    }

    [[nodiscard]] bool can_stack() const override { return true; }

    void warp_stack(std::span<const StackedLayer> layers, const WarpTarget& target, StackBase base,
                    DisplayFrame& out) override {
        std::vector<std::shared_ptr<const PreparedLayer>> own;
        counters_ = {};
        place_layers(layers, target, own);
        if (base == StackBase::nothing) out.resize(target.camera.size_px);
        std::span<const PaintedLayer> to_paint = layers_;
        if (base == StackBase::nothing && matrices_.front().all_identity()) {
            copy_source(layers.front().layer->cpu(), matrices_.front(), out);
            if (layers.size() == 1) return;
            to_paint = to_paint.subspan(1);
            base = StackBase::picture;
        }
        to_paint_ = to_paint;
        base_ = base;
        out_ = &out;
        place_bands(layers.front().layer->camera, target.camera, *layers_.front().input.prepared);
        pool_.run(paint_band_);
        for (const BandPainter& painter : painters_) {
            counters_.tiles_empty += painter.skips().empty;
            counters_.tiles_outside += painter.skips().outside;
            counters_.tiles_hidden += painter.skips().hidden;
            const std::vector<PartlyCovered>& partly = painter.partly_covered();
            out.partly_covered.insert(out.partly_covered.end(), partly.begin(), partly.end());
        }
    }

private:
    // What was prepared for each layer, and its matrices. `own` keeps what had to be made here.
    void place_layers(std::span<const StackedLayer> layers, const WarpTarget& target,
                      std::vector<std::shared_ptr<const PreparedLayer>>& own) {
        if (matrices_.size() < layers.size()) matrices_.resize(layers.size());
        layers_.clear();
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = *layers[i].layer;
            (void)checked_cpu_pixels(layer);
            std::shared_ptr<const PreparedLayer> made;
            const auto& prepared = prepared_or_made<PreparedSurface>(layer, made);
            if (made != nullptr) own.push_back(std::move(made));
            matrices_[i].build(layer, target, layers[i].depth_share);
            counters_ += bad_pixels(prepared.id_counts, matrices_[i]);
            layers_.push_back({{&prepared, &matrices_[i]}, layers[i].reach, layers[i].nearest_depth});
        }
    }

    // Bands of the source that cost the same, moved to where their middles land when the head only turns: near enough
    // for sharing work, and the picture does not depend on it.
    void place_bands(const Camera& source, const Camera& target, const PreparedSurface& prepared) {
        const int threads = pool_.threads();
        const glm::mat3 source_from_target = background_source_from_target(source, target);
        const glm::mat3 target_from_source = glm::inverse(source_from_target);
        const int height = target.size_px.y;
        for (int i = 0; i < threads; ++i) {
            const RowRange rows = band_of_cost(prepared.cost_until, i, threads);
            const glm::vec3 place = target_from_source * glm::vec3{0.5F * static_cast<float>(source.size_px.x),
                                                                   static_cast<float>(rows.end), 1.0F};
            const bool usable = place.z > 0.0F && std::abs(place.y) < 1e6F * place.z;
            const int previous = i == 0 ? 0 : bands_[static_cast<std::size_t>(i) - 1].end;
            const int end = usable ? std::clamp(static_cast<int>(place.y / place.z), previous, height) : previous;
            bands_[static_cast<std::size_t>(i)] = {previous, i + 1 == threads ? height : end};
        }
    }

    // Nothing moves: the source, bit for bit.
    void copy_source(const CpuPixels& pixels, const ObjectMatrices& matrices, DisplayFrame& out) const {
        std::ranges::transform(pixels.colour.pixels(), out.colour.pixels().begin(), opaque);
        std::copy(pixels.depth.pixels().begin(), pixels.depth.pixels().end(), out.depth.pixels().begin());
        const std::span<Coverage> coverage = out.coverage.pixels();
        std::fill(coverage.begin(), coverage.end(), Coverage::reached);
        if (counters_.bad_depth == 0 && counters_.unknown_object == 0) return;
        for (std::size_t i = 0; i < coverage.size(); ++i) {
            const bool usable =
                is_usable_depth(pixels.depth.pixels()[i]) && matrices.find(pixels.object_id.pixels()[i]) != nullptr;
            if (usable) continue;
            coverage[i] = Coverage::hole;
            out.depth.pixels()[i] = kNoSurfaceDepth;
        }
    }

    std::string label_;
    BandPool pool_;
    std::vector<BandPainter> painters_;
    std::vector<RowRange> bands_;
    std::vector<ObjectMatrices> matrices_;  // by layer of the stack
    std::vector<PaintedLayer> layers_;
    std::span<const PaintedLayer> to_paint_;
    StackBase base_ = StackBase::nothing;
    DisplayFrame* out_ = nullptr;
    // Kept, because making a function object may allocate.
    std::function<void(int)> paint_band_ = [this](int thread) {
        painters_[static_cast<std::size_t>(thread)].paint(to_paint_, bands_[static_cast<std::size_t>(thread)], base_,
                                                          *out_);
    };
};

}  // namespace

MadeMethod make_surface_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SurfaceMethod>(std::move(label), *threads)};
}

}  // namespace lw
