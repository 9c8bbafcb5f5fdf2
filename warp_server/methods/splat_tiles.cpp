#include "warp_server/methods/splat_tiles.h"

#include <algorithm>

#include "warp_server/methods/object_matrices.h"

namespace lw {
namespace {

// One block with what a first look shows. Plain loops of fixed length: the compiler makes vectors of them.
struct BlockSummary {
    bool one_object = true;
    bool background = true;
    float least_depth = 1.0F;     // of usable pixels that are not background
    float greatest_depth = 0.0F;  // of the same
    int points = 0;
    int unusable = 0;
};

BlockSummary summary_of(const float* depth, const ObjectId* object, int count) {
    BlockSummary block;
    for (int i = 0; i < count; ++i) {
        const bool usable = is_usable_depth(depth[i]);
        const bool background = depth[i] == 0.0F && object[i] == 0;
        block.one_object &= object[i] == object[0];
        block.background &= background;
        block.points += background ? 0 : 1;
        block.unusable += usable ? 0 : 1;
        block.least_depth = std::min(block.least_depth, usable && !background ? depth[i] : 1.0F);
        block.greatest_depth = std::max(block.greatest_depth, usable ? depth[i] : 0.0F);
    }
    return block;
}

class Builder {
public:
    explicit Builder(const CpuPixels& pixels) : pixels_{pixels} {
        tiles_->size_px = pixels.depth.size_px();
        tiles_->blocks_per_row = (tiles_->size_px.x + kBlockWidth_px - 1) / kBlockWidth_px;
        const auto blocks =
            static_cast<std::size_t>(tiles_->blocks_per_row) * static_cast<std::size_t>(tiles_->size_px.y);
        tiles_->background.resize(blocks);
    }

    std::shared_ptr<const SplatTiles> build() {
        for (int y = 0; y < tiles_->size_px.y; y += kBandHeight_px) add_band(y, std::min(y + kBandHeight_px, height()));
        tiles_->first_patch.push_back(static_cast<int>(tiles_->patches.size()));
        return tiles_;
    }

private:
    [[nodiscard]] int width() const { return tiles_->size_px.x; }
    [[nodiscard]] int height() const { return tiles_->size_px.y; }
    [[nodiscard]] std::size_t index(int block, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_->blocks_per_row) +
               static_cast<std::size_t>(block);
    }

    void add_band(int begin_y, int end_y) {
        tiles_->first_patch.push_back(static_cast<int>(tiles_->patches.size()));
        const int blocks_per_tile = kTileWidth_px / kBlockWidth_px;
        for (int tile = 0; tile < tiles_->tiles_per_band(); ++tile) {
            first_of_tile_ = tiles_->patches.size();
            tiles_->points.push_back(0);
            const int end_block = std::min((tile + 1) * blocks_per_tile, tiles_->blocks_per_row);
            for (int y = begin_y; y < end_y; ++y) {
                for (int block = tile * blocks_per_tile; block < end_block; ++block) add_block(tile, block, y);
            }
            add_runs({{tile * kTileWidth_px, begin_y}, {std::min((tile + 1) * kTileWidth_px, width()), end_y}});
        }
    }

    void add_runs(const PixelRect& tile) {
        std::vector<SplatRun>& runs = tiles_->runs;
        const std::size_t first = runs.size();
        if (tiles_->points.back() > 0) append_runs(pixels_, tile, runs, others_);
        tiles_->tile_runs.push_back({first, runs.size(), runs.size() + others_.size()});
        runs.insert(runs.end(), others_.begin(), others_.end());
        others_.clear();
    }

    void add_block(int tile, int block, int y) {
        const int x = block * kBlockWidth_px;
        const float* depth = pixels_.depth.row(y).data() + x;
        const ObjectId* object = pixels_.object_id.row(y).data() + x;
        const int count = std::min(kBlockWidth_px, tiles_->size_px.x - x);
        const BlockSummary summary =
            count == kBlockWidth_px ? summary_of(depth, object, kBlockWidth_px) : summary_of(depth, object, count);
        tiles_->background[index(block, y)] = summary.background        ? BackgroundShare::all
                                              : summary.points == count ? BackgroundShare::none
                                                                        : BackgroundShare::some;
        if (summary.background) return;
        tiles_->points.back() += summary.points;
        if (summary.one_object) {
            count_pixels(object[0], summary.points, summary.unusable);
            add_to_patch(tile, object[0], summary.least_depth, summary.greatest_depth);
            return;
        }
        for (int k = 0; k < count; ++k) {
            const bool background = depth[k] == 0.0F && object[k] == 0;
            if (background) continue;
            const bool usable = is_usable_depth(depth[k]);
            count_pixels(object[k], 1, usable ? 0 : 1);
            if (usable) add_to_patch(tile, object[k], depth[k], depth[k]);
        }
    }

    void count_pixels(ObjectId object, int all, int unusable) {
        auto& counts = tiles_->pixels_of_object;
        if (object >= counts.size()) counts.resize(std::size_t{object} + 1);
        counts[object].all += static_cast<std::uint64_t>(all);
        counts[object].unusable += static_cast<std::uint64_t>(unusable);
    }

    void add_to_patch(int tile, ObjectId object, float least_depth, float greatest_depth) {
        for (std::size_t i = tiles_->patches.size(); i > first_of_tile_; --i) {
            TilePatch& patch = tiles_->patches[i - 1];
            if (patch.object != object) continue;
            patch.least_depth = std::min(patch.least_depth, least_depth);
            patch.greatest_depth = std::max(patch.greatest_depth, greatest_depth);
            return;
        }
        tiles_->patches.push_back({tile, object, least_depth, greatest_depth});
    }

    const CpuPixels& pixels_;
    std::shared_ptr<SplatTiles> tiles_ = std::make_shared<SplatTiles>();
    std::vector<SplatRun> others_;   // of the tile being added, those that are not smooth
    std::size_t first_of_tile_ = 0;  // patches of the tile being added start here
};

}  // namespace

std::shared_ptr<const SplatTiles> tiles_of(const CpuPixels& pixels) { return Builder{pixels}.build(); }

}  // namespace lw
