#include "warp_server/methods/splat_tiles.h"

#include <algorithm>
#include <bit>

namespace lw {
namespace {

class Builder {
public:
    explicit Builder(const CpuPixels& pixels) : pixels_{pixels} {
        tiles_->size_px = pixels.depth.size_px();
        tiles_->blocks_per_row = (tiles_->size_px.x + kBlockWidth_px - 1) / kBlockWidth_px;
        const auto blocks =
            static_cast<std::size_t>(tiles_->blocks_per_row) * static_cast<std::size_t>(tiles_->size_px.y);
        tiles_->background.resize(blocks);
        tiles_->runs.reserve(blocks);
    }

    std::shared_ptr<const SplatTiles> build() {
        const glm::ivec2 size_px = tiles_->size_px;
        for (int y = 0; y < size_px.y; y += kBandHeight_px) {
            tiles_->first_patch.push_back(static_cast<int>(tiles_->patches.size()));
            for (int tile = 0; tile < tiles_->tiles_per_band(); ++tile) {
                const glm::ivec2 first_px{tile * kTileWidth_px, y};
                add_tile(tile, {first_px, glm::min(first_px + glm::ivec2{kTileWidth_px, kBandHeight_px}, size_px)});
            }
        }
        tiles_->first_patch.push_back(static_cast<int>(tiles_->patches.size()));
        return tiles_;
    }

private:
    void add_tile(int tile, const PixelRect& rect) {
        find_runs(pixels_, rect, found_);
        for (const ObjectDepths& depths : found_.objects) {
            tiles_->patches.push_back({tile, depths.object, depths.least, depths.greatest});
        }
        std::vector<SplatRun>& runs = tiles_->runs;
        const std::size_t first = runs.size();
        runs.insert(runs.end(), found_.smooth.begin(), found_.smooth.end());
        const std::size_t first_other = runs.size();
        runs.insert(runs.end(), found_.others.begin(), found_.others.end());
        tiles_->tile_runs.push_back({first, first_other, runs.size()});

        int points = 0;
        for (const SplatRun& run : std::span{runs}.subspan(first)) {
            points += std::popcount(run.points);
            counts_of(run.object).all += static_cast<std::uint64_t>(std::popcount(run.points));
        }
        tiles_->points.push_back(points);

        auto rest = found_.rests.begin();
        for (int x = rect.first_px.x; x < rect.end_px.x; x += kBlockWidth_px) {
            for (int y = rect.first_px.y; y < rect.end_px.y; ++y) add_rest(x, y, *rest++);
        }
    }

    void add_rest(int x, int y, const BlockRest& rest) {
        const int count = std::min(kBlockWidth_px, tiles_->size_px.x - x);
        const int background = std::popcount(rest.background);
        tiles_->background[static_cast<std::size_t>(y) * static_cast<std::size_t>(tiles_->blocks_per_row) +
                           static_cast<std::size_t>(x / kBlockWidth_px)] = background == 0 ? BackgroundShare::none
                                                                           : background == count
                                                                               ? BackgroundShare::all
                                                                               : BackgroundShare::some;
        for (unsigned bits = rest.unusable; bits != 0; bits &= bits - 1) {
            ObjectPixels& counts = counts_of(pixels_.object_id.at(x + std::countr_zero(bits), y));
            ++counts.all;
            ++counts.unusable;
        }
    }

    ObjectPixels& counts_of(ObjectId object) {
        auto& counts = tiles_->pixels_of_object;
        if (object >= counts.size()) counts.resize(std::size_t{object} + 1);
        return counts[object];
    }

    const CpuPixels& pixels_;
    std::shared_ptr<SplatTiles> tiles_ = std::make_shared<SplatTiles>();
    TilePixels found_;  // of the tile being added
};

}  // namespace

std::shared_ptr<const SplatTiles> tiles_of(const CpuPixels& pixels) { return Builder{pixels}.build(); }

}  // namespace lw
