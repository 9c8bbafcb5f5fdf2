/// Every source pixel is a point, moved by its object's matrix; the winner rule decides each target pixel.

#include <algorithm>

#include "core/stopwatch.h"
#include "core/task_pool.h"
#include "warp_server/methods/factories.h"
#include "warp_server/methods/homography_resample.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/splat_kernels.h"
#include "warp_server/methods/splat_parts.h"
#include "warp_server/methods/splat_reach.h"
#include "warp_server/methods/splat_resolve.h"
#include "warp_server/methods/splat_tiles.h"

namespace lw {
namespace {

// In each part of the target, bands of the source are worked on in order, and a target row is finished as soon as no
// later band can reach it.
// Threads share the parts, each with keys of its own: a tile that lands in two parts is placed twice, nothing is
// merged, and the larger key wins whoever wrote it, so the picture does not depend on the parts.
class SplatMethod final : public WarpMethod {
public:
    SplatMethod(std::string label, int threads)
        : label_{std::move(label)}, pool_{threads}, painters_(static_cast<std::size_t>(threads)) {}

    [[nodiscard]] std::string_view label() const override { return label_; }
    [[nodiscard]] TaskPool* threads() override { return &pool_; }

    [[nodiscard]] std::shared_ptr<const PreparedLayer> prepare(const Layer& layer) const override {
        return tiles_of(checked_cpu_pixels(layer));
    }

    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        const CpuPixels& pixels = checked_cpu_pixels(layer);
        std::shared_ptr<const PreparedLayer> own;
        const auto& tiles = prepared_or_made<SplatTiles>(layer, own);
        matrices_.build(layer, target, 1.0F, &pool_);
        reach_.build(tiles, matrices_, target.camera.size_px, &pool_);
        parts_.build(reach_, tiles, pool_.threads());
        out.resize(target.camera.size_px);
        for (Painter& painter : painters_) painter.keys.reserve(target.camera.size_px);
        input_ = {&pixels, &tiles, &matrices_};
        background_ = {background_source_from_target(layer.camera, target.camera)};
        out_ = &out;
        part_ms_.resize(parts_.all().size());
        pool_.run(static_cast<int>(parts_.all().size()), draw_part_);
        parts_.learn(part_ms_);
        count_bad_pixels(tiles);
    }

private:
    // What one thread draws with.
    struct Painter {
        SplatPart part;
        KeyRing keys;
    };

    void draw_part(const PixelRect& rect, Painter& painter) {
        SplatPart& part = painter.part;
        KeyRing& keys = painter.keys;
        part.build(reach_, rect);
        keys.reshape({rect.first_px.x, rect.end_px.x}, part.rows_in_flight());
        int finished = rect.first_px.y;  // rows before are done
        int reached = finished;          // rows from here on were not written yet
        finish_rows(finished, reached, part.first_row_from_band(0), keys);
        for (int band = 0; band < input_.tiles->bands(); ++band) {
            const RowRange rows = part.rows_of_band(band);
            if (rows.begin < rows.end) {
                splat_band(input_, band, part.landings(band), {finished, rect.end_px.y}, keys);
                reached = std::max(rows.end, reached);
            }
            finish_rows(finished, reached, part.first_row_from_band(band + 1), keys);
        }
    }

    // Resolves the rows from `finished` to `end`.
    void finish_rows(int& finished, int& reached, int end, KeyRing& keys) {
        if (end <= finished) return;
        const int end_reached = std::min(end, reached);
        if (finished < end_reached) resolve_rows(input_, background_, {finished, end_reached}, keys, *out_);
        const int begin_unreached = std::max(finished, end_reached);
        const int end_column = keys.first_column() + keys.width();
        resolve_unreached(input_, background_, {{keys.first_column(), begin_unreached}, {end_column, end}}, *out_);
        finished = end;
        reached = std::max(reached, end);
    }

    void count_bad_pixels(const SplatTiles& tiles) {
        counters_ = {};
        for (std::size_t id = 0; id < tiles.pixels_of_object.size(); ++id) {
            const ObjectPixels& pixels = tiles.pixels_of_object[id];
            const bool known = matrices_.find(static_cast<ObjectId>(id)) != nullptr;
            counters_.bad_depth += known ? pixels.unusable : 0;
            counters_.unknown_object += known ? 0 : pixels.all;
        }
    }

    std::string label_;
    TaskPool pool_;
    std::vector<Painter> painters_;  // by worker
    ObjectMatrices matrices_;
    SplatReach reach_;
    SplatParts parts_;
    SplatInput input_;
    BackgroundLookup background_;
    DisplayFrame* out_ = nullptr;
    std::vector<double> part_ms_;
    // Kept, because making a function object may allocate.
    TaskPool::Work draw_part_ = [this](int part, int worker) {
        const Stopwatch drawing;
        draw_part(parts_.all()[static_cast<std::size_t>(part)], painters_[static_cast<std::size_t>(worker)]);
        part_ms_[static_cast<std::size_t>(part)] = drawing.ms();
    };
};

}  // namespace

MadeMethod make_splat_method(std::string label, const MethodSettings& settings) {
    const Result<int> threads = whole_setting(label, settings, "threads", 1, 1, 16);
    if (!threads) return threads.error();
    return std::unique_ptr<WarpMethod>{std::make_unique<SplatMethod>(std::move(label), *threads)};
}

}  // namespace lw
