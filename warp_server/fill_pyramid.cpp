#include "warp_server/fill_pyramid.h"

#include <algorithm>

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
        mark_tiles();
        collect_tiles(guide);
        set_limits(frame);
        collect_tile_runs();
        const FillPixels pixels{frame.colour.pixels().data(), frame.depth.pixels().data(), frame.coverage.size_px()};
        pull(pixels);
        push(pixels);
        for (const HoleRun& run : ends_.runs()) {
            const auto row = frame.coverage.row(run.y);
            std::fill(row.begin() + run.begin, row.begin() + run.end, Coverage::filled);
        }
    }

private:
    static constexpr std::uint8_t kBeside = 1;
    static constexpr std::uint8_t kWithHoles = 2;

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
        towards_.resize(tiles);
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

    static HolePart whole(const HoleRun& run) { return {run, {run.begin, run.end}}; }

    void set_limits(DisplayFrame& frame) {
        scratch_.resize(frame.depth.width());
        const std::span<const HoleRun> runs = ends_.runs();
        for (std::size_t i = runs.size(); i-- > 0;) look_below(frame, whole(runs[i]), scratch_);
        for (const HoleRun& run : runs) {
            const int middle = (run.begin + run.end) / 2 / kFillTile_px;
            const FillCosts costs = costs_along(towards_.at(middle, run.y / kFillTile_px));
            choose_background(frame, whole(run), costs, scratch_);
            copy_background(frame, whole(run), kNothingColour, scratch_);
            for (int x = run.begin; x < run.end; ++x) {
                frame.depth.at(x, run.y) = hole_with_limit(frame.depth.at(x, run.y));
                frame.colour.at(x, run.y).a = part_of_copy(scratch_.cost[static_cast<std::size_t>(x)]);
            }
        }
        ends_.spread_sideways([&](int y, int x, int from_x) {
            frame.depth.at(x, y) = frame.depth.at(from_x, y);
            frame.colour.at(x, y) = frame.colour.at(from_x, y);
            frame.colour.at(x, y).a = 0;
        });
    }

    // Half pixels of distance along the background's side, three times that against it.
    static FillCosts costs_along(const glm::vec2& towards) {
        const auto cost = [](float along) { return static_cast<std::int32_t>(4.5F - 2.0F / kTowards_cells * along); };
        return {cost(-towards.x), cost(towards.x), cost(-towards.y), cost(towards.y)};
    }

    // As alpha: 255 right beside the background, 0 where only the pyramid counts.
    static std::uint8_t part_of_copy(std::int32_t cost) {
        const std::int32_t faded = 255 * (std::min(cost, kCopiedCost) - kLeastCost) / (kCopiedCost - kLeastCost);
        return static_cast<std::uint8_t>(255 - std::clamp(faded, 0, 255));
    }

    // Tiles with holes and those beside them.
    void mark_tiles() {
        std::fill(tiles_.pixels().begin(), tiles_.pixels().end(), std::uint8_t{0});
        for (const HoleRun& run : ends_.runs()) {
            const auto row = tiles_.row(run.y / kFillTile_px);
            std::fill(row.begin() + run.begin / kFillTile_px, row.begin() + (run.end - 1) / kFillTile_px + 1,
                      kWithHoles);
        }
        for (int y = 0; y < tiles_.height(); ++y) {
            for (int x = 0; x < tiles_.width(); ++x) {
                if ((tiles_.at(x, y) & kWithHoles) != 0) mark_beside({x, y});
            }
        }
    }

    void mark_beside(glm::ivec2 tile) {
        const glm::ivec2 first = glm::max(tile - 1, glm::ivec2{0});
        const glm::ivec2 last = glm::min(tile + 1, tiles_.size_px() - 1);
        for (int y = first.y; y <= last.y; ++y) {
            for (int x = first.x; x <= last.x; ++x) tiles_.at(x, y) |= kBeside;
        }
    }

    void collect_tiles(const FillGuide& guide) {
        spans_.clear();
        with_holes_.clear();
        std::vector<FillCell>& cells = levels_[kFillTileLevel].cells;
        std::fill(cells.begin(), cells.end(), FillCell{0.0F, 0.0F, 0.0F, kUnknownCell});
        for (int y = 0; y < tiles_.height(); ++y) {
            for (int x = 0; x < tiles_.width(); ++x) {
                const std::uint8_t tile = tiles_.at(x, y);
                if (tile == 0) continue;
                if (spans_.empty() || spans_.back().y != y || spans_.back().end != x) spans_.push_back({y, x, x});
                spans_.back().end = x + 1;
                if ((tile & kWithHoles) == 0) continue;
                const glm::dvec2 centre_px = (glm::dvec2{x, y} + 0.5) * static_cast<double>(kFillTile_px);
                towards_.at(x, y) = kTowards_cells * direction(guide.background_px_m(centre_px));
                with_holes_.push_back({{x, y}, towards_.at(x, y)});
            }
        }
    }

    // The runs, cut where tiles end.
    void collect_tile_runs() {
        tile_runs_.clear();
        for (const HoleRun& run : ends_.runs()) {
            for (int x = run.begin; x < run.end;) {
                const int tile = x / kFillTile_px;
                const int end = std::min(run.end, (tile + 1) * kFillTile_px);
                tile_runs_.push_back({run.y, x, end, towards_.at(tile, run.y / kFillTile_px)});
                x = end;
            }
        }
    }

    // At most 1 long.
    static glm::vec2 direction(const glm::dvec2& background_px_m) {
        return glm::vec2{background_px_m / std::max(glm::length(background_px_m), kFullDirection_px_m)};
    }

    void pull(const FillPixels& pixels) {
        pull_tiles(pixels, spans_, levels_);
        for (std::size_t i = kFillTileLevel + 1; i < levels_.size(); ++i) pull_level(levels_[i - 1], levels_[i]);
    }

    void push(const FillPixels& pixels) {
        for (std::size_t i = levels_.size() - 1; i > kFillTileLevel; --i) push_level(levels_[i], levels_[i - 1]);
        push_tiles(levels_[3], with_holes_, 2, levels_[2]);
        push_tiles(levels_[2], with_holes_, 4, levels_[1]);
        push_pixels(levels_[1], tile_runs_, pixels);
    }

    HoleEnds ends_;
    HoleScratch scratch_;
    glm::ivec2 size_px_{0};
    std::vector<FillLevel> levels_;  // the first is the picture and stays empty
    Image<std::uint8_t> tiles_;      // kBeside, kWithHoles or both; 0 for those that no hole is near
    Image<glm::vec2> towards_;       // of tiles with holes: as FillTile
    std::vector<FillTileSpan> spans_;
    std::vector<FillTile> with_holes_;
    std::vector<FillTileRun> tile_runs_;
};

}  // namespace

std::unique_ptr<Fill> make_pyramid_fill() { return std::make_unique<PyramidFill>(); }

}  // namespace lw
