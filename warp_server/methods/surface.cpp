/// The default: the source is cut into pieces of plane (large blocks, and single cells along edges); each piece is laid
/// over the target, where every pixel in it asks for its exact place in the source and reads the colour there.

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "core/task_pool.h"
#include "warp_server/methods/band_balance.h"
#include "warp_server/methods/depth_rows.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_canvas.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_costs.h"
#include "warp_server/methods/surface_kernels.h"
#include "warp_server/methods/surface_split.h"
#include "warp_server/methods/surface_tolerances.h"
#include "warp_server/stepped_warp.h"

namespace lw {
namespace {

// A source denser than the target has pixels to spare: a read between them as sharp as the lattice's would show what is
// finer than the target's pixels. (Density 2 with 2x2 samples: FLIP 0.0264 with the lattice, 0.0222 without; density 1:
// 0.0245 and 0.0337.)
constexpr double kDensestForLattice = 1.4;

// Emptying a pixel and saying whether it was reached, in pixels of a large block, as surface_costs.h counts.
constexpr float kCostPerTargetPixel = 0.2F;

double pixels_per_tangent(const Camera& camera) { return camera.size_px.x / (camera.fov.right - camera.fov.left); }

bool reads_between_pixels(const Camera& source, const Camera& target) {
    return pixels_per_tangent(source) <= kDensestForLattice * pixels_per_tangent(target);
}

// A layer to be drawn, and where it shows anything.
struct PaintedLayer {
    PatchInput input;
    PixelRect reach;
    float nearest_depth = 1.0F;
};

// Draws one band of rows of the target. As many as threads: what crosses a border is drawn on both sides, and twice the
// bands took a tenth more time.
class BandPainter {
public:
    // `layers` outlives the steps; at least one.
    void begin(std::span<const PaintedLayer> layers, RowRange band, StackBase base, DisplayFrame& out) {
        out_ = &out;
        band_ = band;
        base_ = base;
        is_begun_ = false;
        layers_ = layers;
        next_layer_ = 0;
        next_region_ = 0;
        is_empty_ = base == StackBase::nothing;
        drawing_ms_ = 0.0;
    }

    void begin_nothing() { layers_ = {}; }

    // Draws the next region; false when all layers were drawn.
    bool step() {
        if (next_layer_ == layers_.size()) return false;
        const Stopwatch drawing;
        // By the thread that draws the band: it empties it.
        if (!is_begun_) canvas_.begin(*out_, band_, base_);
        is_begun_ = true;
        draw_next();
        drawing_ms_ += drawing.ms();
        return true;
    }

    /// Of the last picture.
    [[nodiscard]] const SurfaceSkips& skips() const { return canvas_.skips(); }
    [[nodiscard]] const std::vector<PartlyCovered>& partly_covered() const { return canvas_.partly_covered(); }
    [[nodiscard]] double drawing_ms() const { return drawing_ms_; }

private:
    void draw_next() {
        const PaintedLayer& layer = layers_[next_layer_];
        if (next_region_ > 0 || is_empty_ || may_show(layer)) {
            const PreparedSurface& prepared = *layer.input.prepared;
            const SurfaceRegion begin = next_region_ == 0 ? SurfaceRegion{} : prepared.regions[next_region_ - 1];
            const SurfaceRegion& end = prepared.regions[next_region_];
            if (may_show(layer, prepared.bounds[next_region_], begin, end)) draw_region(layer.input, begin, end);
            if (++next_region_ < prepared.regions.size()) return;
            if (layers_.size() > 1) canvas_.finish_layer();
            is_empty_ = false;
        }
        next_region_ = 0;
        if (++next_layer_ == layers_.size()) canvas_.finish();
    }

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

    // Does any of a region lie in the picture, and before what is there? Counts its pieces where not.
    [[nodiscard]] bool may_show(const PaintedLayer& layer, const RegionBounds& bounds, const SurfaceRegion& begin,
                                const SurfaceRegion& end) {
        if (bounds.empty) return false;
        const PixelMatrix* matrix = layer.input.matrices->find(0);
        const std::optional<RegionReach> reach = matrix != nullptr ? reach_of(bounds, *matrix) : std::nullopt;
        if (!reach) return true;
        const PixelRect rect = common(reach->rect, layer.reach);
        const std::uint64_t pieces =
            end.blocks - begin.blocks + end.patches - begin.patches + end.tiles - begin.tiles + end.edges - begin.edges;
        if (rect.empty()) {
            if (canvas_.band().begin == 0) canvas_.skips().outside += pieces;
            return false;
        }
        const RowRange band = canvas_.band();
        const PixelRect here = common(rect, {{rect.first_px.x, band.begin}, {rect.end_px.x, band.end}});
        if (here.empty()) return false;
        if (is_empty_ || !all_nearer(canvas_.frame().depth, here, reach->nearest_depth)) return true;
        canvas_.skips().hidden += pieces;
        return false;
    }

    void draw_region(const PatchInput& input, const SurfaceRegion& begin, const SurfaceRegion& end) {
        draw_list(input, input.prepared->blocks, {begin.blocks, end.blocks});
        draw_list(input, input.prepared->patches, {begin.patches, end.patches});
        draw_tile_list(input, {begin.tiles, end.tiles});
        draw_list(input, input.prepared->edges, {begin.edges, end.edges});
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

    DisplayFrame* out_ = nullptr;
    RowRange band_;
    StackBase base_ = StackBase::nothing;
    bool is_begun_ = false;
    SurfaceCanvas canvas_;
    std::span<const PaintedLayer> layers_;
    std::size_t next_layer_ = 0;
    std::size_t next_region_ = 0;  // of it
    bool is_empty_ = true;         // nothing is in the picture yet
    double drawing_ms_ = 0.0;
    std::vector<std::uint32_t> behind_;
    PatchList parts_;
    PatchList smaller_parts_;
    PatchList edge_parts_;
};

class SurfaceMethod final : public WarpMethod, public SteppedWarp {
public:
    SurfaceMethod(std::string label, int threads, bool flatten)
        : label_{std::move(label)}, pool_{threads}, flatten_{flatten} {}

    [[nodiscard]] std::string_view label() const override { return label_; }
    [[nodiscard]] TaskPool* threads() override { return &pool_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        const float unseen_step = flatten_ ? unseen_depth_step(layer.camera) : 0.0F;
        return classify_surfaces(checked_cpu_pixels(layer), SurfaceUse::cpu_kernels, unseen_step, pool_.threads());
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        const StackedLayer alone{&layer, 1.0F, {{0, 0}, target.camera.size_px}, 1.0F};
        warp_stack({&alone, 1}, target, StackBase::nothing, out);
    }

    [[nodiscard]] bool can_stack() const override { return true; }

    void warp_stack(std::span<const StackedLayer> layers, const WarpTarget& target, StackBase base,
                    DisplayFrame& out) override {
        begin_stack(layers, target, base, pool_.threads(), out);
        if (!to_paint_.empty()) pool_.run(static_cast<int>(bands_.size()), paint_band_);
        finish_stack();
    }

    void begin_stack(std::span<const StackedLayer> layers, const WarpTarget& target, StackBase base, int bands,
                     DisplayFrame& out) override {
        counters_ = {};
        out_ = &out;
        place_layers(layers, target);
        if (base == StackBase::nothing) out.resize(target.camera.size_px);
        to_paint_ = layers_;
        if (base == StackBase::nothing && matrices_.front().all_identity()) {
            copy_source(layers.front().layer->cpu(), matrices_.front(), out);
            to_paint_ = to_paint_.subspan(1);
            base = StackBase::picture;
        }
        is_whole_ = base == StackBase::nothing;
        bands_.resize(static_cast<std::size_t>(bands));
        painters_.resize(bands_.size());
        place_bands(target.camera.size_px);
        for (std::size_t i = 0; i < bands_.size(); ++i) {
            if (to_paint_.empty()) {
                painters_[i].begin_nothing();
            } else {
                painters_[i].begin(to_paint_, bands_[i], base, out);
            }
        }
    }

    bool step(int band) override { return painters_[static_cast<std::size_t>(band)].step(); }

    void finish_stack() override {
        own_.clear();
        if (to_paint_.empty()) return;
        band_times_.clear();
        for (const BandPainter& painter : painters_) {
            band_times_.push_back(painter.drawing_ms());
            counters_.tiles_empty += painter.skips().empty;
            counters_.tiles_outside += painter.skips().outside;
            counters_.tiles_hidden += painter.skips().hidden;
            const std::vector<PartlyCovered>& partly = painter.partly_covered();
            out_->partly_covered.insert(out_->partly_covered.end(), partly.begin(), partly.end());
        }
        if (is_whole_) balance_.learn(band_times_);
    }

private:
    // What was prepared for each layer, and its matrices.
    void place_layers(std::span<const StackedLayer> layers, const WarpTarget& target) {
        if (matrices_.size() < layers.size()) matrices_.resize(layers.size());
        layers_.clear();
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const Layer& layer = *layers[i].layer;
            (void)checked_cpu_pixels(layer);
            std::shared_ptr<const PreparedLayer> made;
            const auto& prepared = prepared_or_made<PreparedSurface>(layer, made);
            if (made != nullptr) own_.push_back(std::move(made));
            matrices_[i].build(layer, target, layers[i].depth_share, &pool_);
            counters_ += bad_pixels(prepared.id_counts, matrices_[i]);
            const bool between_pixels = reads_between_pixels(layer.camera, target.camera);
            layers_.push_back({{&prepared, &matrices_[i], between_pixels}, layers[i].reach, layers[i].nearest_depth});
        }
    }

    // The picture does not depend on where they meet.
    void place_bands(glm::ivec2 target_size_px) {
        row_costs_.begin(target_size_px.y, kCostPerTargetPixel * static_cast<float>(target_size_px.x));
        for (const PaintedLayer& layer : to_paint_) {
            const PixelMatrix* matrix = layer.input.matrices->find(0);
            if (matrix != nullptr) add_costs(*layer.input.prepared, *matrix, target_size_px, row_costs_);
        }
        balance_.cut(row_costs_.until(), bands_);
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
    TaskPool pool_;
    bool flatten_;
    std::vector<BandPainter> painters_;  // by band
    std::vector<RowRange> bands_;
    RowCosts row_costs_;
    BandBalance balance_;    // of whole pictures
    bool is_whole_ = false;  // the picture being drawn: not more layers over one
    std::vector<double> band_times_;

    // Of the picture being drawn.
    std::vector<std::shared_ptr<const PreparedLayer>> own_;  // what was not prepared before
    std::vector<ObjectMatrices> matrices_;                   // by layer of the stack
    std::vector<PaintedLayer> layers_;
    std::span<const PaintedLayer> to_paint_;
    DisplayFrame* out_ = nullptr;
    // Kept, because making a function object may allocate.
    TaskPool::Work paint_band_ = [this](int band, int /*worker*/) {
        while (step(band)) {
        }
    };
};

}  // namespace

MadeMethod make_surface_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    const Result<int> flatten = whole_setting(label, settings, "flatten", 0, 0, 1);
    if (!flatten) return flatten.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SurfaceMethod>(std::move(label), *threads, *flatten == 1)};
}

}  // namespace lw
