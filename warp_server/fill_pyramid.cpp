#include "warp_server/fill_pyramid.h"

#include <algorithm>
#include <cmath>

#include "warp_server/fill_pyramid_kernels.h"
#include "warp_server/hole_ends.h"

namespace lw {
namespace {

// A head motion that moves something 1 m away by this much has a direction worth following; below, it fades out.
constexpr double kFullDirection_px_m = 4.0;
// How far each level looks towards the background's side, in its cells. 0 and 1 gave 1.5 and 0.5 % more FLIP in holes.
constexpr float kTowards_cells = 0.5F;
// Beside the background its closest pixel is continued as it is, fading out over this cost (costs_of()): averages alone
// blur the holes of one or two pixels, which are most of them (4 % more FLIP in holes).
constexpr std::int32_t kCopiedCost = 24;
constexpr std::int32_t kLeastCost = 2;  // of the closest pixel on the background's side

class PyramidFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "pyramid"; }

    void apply(DisplayFrame& frame, const FillGuide& guide) override {
        ends_.find(frame);
        if (ends_.runs().empty()) return;
        if (ends_.hole_count() == frame.coverage.pixels().size()) return show_nothing(frame);
        resize(frame.coverage.size_px());
        for (const HoleRun& run : ends_.runs()) {
            set_limits(frame, run, ends_.background_of(frame, run, costs_of(run, guide)));
        }
        mark_tiles();
        collect_tiles(guide);
        const FillPixels pixels{frame.colour.pixels().data(), frame.depth.pixels().data(), frame.coverage.size_px()};
        pull(pixels);
        push(pixels);
        for (const HoleRun& run : ends_.runs()) {
            const auto row = frame.coverage.row(run.y);
            std::fill(row.begin() + run.begin, row.begin() + run.end, Coverage::filled);
        }
    }

private:
    enum class Tile : std::uint8_t { unused, beside, with_holes };

    static void show_nothing(DisplayFrame& frame) {
        std::fill(frame.colour.pixels().begin(), frame.colour.pixels().end(), kNothingColour);
        std::fill(frame.depth.pixels().begin(), frame.depth.pixels().end(), 0.0F);
        std::fill(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::filled);
    }

    // Levels 1 and 2 hold whole tiles, so that a tile's cells never leave them.
    void resize(glm::ivec2 size_px) {
        if (size_px == size_px_) return;
        size_px_ = size_px;
        const glm::ivec2 tiles = (size_px + (kFillTile_px - 1)) / kFillTile_px;
        tiles_.resize(tiles);
        levels_.resize(kFillTileLevel);
        for (glm::ivec2 size = tiles;; size = (size + 1) / 2) {
            levels_.push_back({size, {}});
            if (size == glm::ivec2{1}) break;
        }
        for (int level = 1; level < kFillTileLevel; ++level) {
            levels_[static_cast<std::size_t>(level)].size = tiles << (kFillTileLevel - level);
        }
        for (FillLevel& level : levels_) {
            level.cells.resize(static_cast<std::size_t>(level.size.x) * static_cast<std::size_t>(level.size.y));
        }
    }

    static void set_limits(DisplayFrame& frame, const HoleRun& run, const HoleBackground& background) {
        const std::span<float> depths = frame.depth.pixels();
        const std::span<Rgba8> colours = frame.colour.pixels();
        const std::span<float> depth_to = frame.depth.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        const std::span<Rgba8> colour_to = frame.colour.row(run.y).subspan(static_cast<std::size_t>(run.begin));
        for (std::size_t i = 0; i < background.index.size(); ++i) {
            const auto from = static_cast<std::size_t>(background.index[i]);
            depth_to[i] = hole_with_limit(limit_at(depths[from]));
            colour_to[i] = colours[from];
            colour_to[i].a = part_of_copy(background.cost[i]);
        }
    }

    // Half pixels of distance along the background's side, three times that against it.
    static FillCosts costs_of(const HoleRun& run, const FillGuide& guide) {
        const glm::vec2 way = direction(guide.background_px_m({0.5 * (run.begin + run.end), run.y + 0.5}));
        const auto cost = [](float along) { return static_cast<std::int32_t>(std::lround(4.0F - 2.0F * along)); };
        return {cost(-way.x), cost(way.x), cost(-way.y), cost(way.y)};
    }

    // As alpha: 255 right beside the background, 0 where only the pyramid counts.
    static std::uint8_t part_of_copy(std::int32_t cost) {
        const std::int32_t faded = 255 * (std::min(cost, kCopiedCost) - kLeastCost) / (kCopiedCost - kLeastCost);
        return static_cast<std::uint8_t>(255 - std::clamp(faded, 0, 255));
    }

    // The background of a run's end may itself be a hole that took its limit already (a row without reached pixels).
    static float limit_at(float depth) { return depth >= 0.0F ? depth : -1.0F - depth; }

    void mark_tiles() {
        std::fill(tiles_.pixels().begin(), tiles_.pixels().end(), Tile::unused);
        for (const HoleRun& run : ends_.runs()) {
            const auto row = tiles_.row(run.y / kFillTile_px);
            std::fill(row.begin() + run.begin / kFillTile_px, row.begin() + (run.end - 1) / kFillTile_px + 1,
                      Tile::with_holes);
        }
        for (int y = 0; y < tiles_.height(); ++y) {
            for (int x = 0; x < tiles_.width(); ++x) {
                if (tiles_.at(x, y) == Tile::with_holes) mark_beside({x, y});
            }
        }
    }

    void mark_beside(glm::ivec2 tile) {
        const glm::ivec2 first = glm::max(tile - 1, glm::ivec2{0});
        const glm::ivec2 last = glm::min(tile + 1, tiles_.size_px() - 1);
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) {
                if (tiles_.at(x, y) == Tile::unused) tiles_.at(x, y) = Tile::beside;
            }
        }
    }

    void collect_tiles(const FillGuide& guide) {
        used_.clear();
        with_holes_.clear();
        FillLevel& level = levels_[kFillTileLevel];
        for (int y = 0; y < tiles_.height(); ++y) {
            for (int x = 0; x < tiles_.width(); ++x) {
                const Tile tile = tiles_.at(x, y);
                if (tile == Tile::unused) {
                    level.cells[static_cast<std::size_t>(y * tiles_.width() + x)] = {0.0F, 0.0F, 0.0F, kUnknownCell};
                    continue;
                }
                const glm::dvec2 centre_px = (glm::dvec2{x, y} + 0.5) * static_cast<double>(kFillTile_px);
                used_.push_back({{x, y}, kTowards_cells * direction(guide.background_px_m(centre_px))});
                if (tile == Tile::with_holes) with_holes_.push_back(used_.back());
            }
        }
    }

    // At most 1 long.
    static glm::vec2 direction(const glm::dvec2& background_px_m) {
        return glm::vec2{background_px_m / std::max(glm::length(background_px_m), kFullDirection_px_m)};
    }

    void pull(const FillPixels& pixels) {
        pull_tiles(pixels, used_, levels_);
        for (std::size_t i = kFillTileLevel + 1; i < levels_.size(); ++i) pull_level(levels_[i - 1], levels_[i]);
    }

    void push(const FillPixels& pixels) {
        for (std::size_t i = levels_.size() - 1; i > kFillTileLevel; --i) push_level(levels_[i], levels_[i - 1]);
        push_tiles(levels_[3], with_holes_, 2, levels_[2]);
        push_tiles(levels_[2], with_holes_, 4, levels_[1]);
        push_pixels(levels_[1], with_holes_, pixels);
    }

    HoleEnds ends_;
    glm::ivec2 size_px_{0};
    std::vector<FillLevel> levels_;  // the first is the picture and stays empty
    Image<Tile> tiles_;
    std::vector<FillTile> used_;  // those with holes and those beside them
    std::vector<FillTile> with_holes_;
};

}  // namespace

std::unique_ptr<Fill> make_pyramid_fill() { return std::make_unique<PyramidFill>(); }

}  // namespace lw
