#include "warp_server/fill_nearest_background.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <vector>

namespace lw {
namespace {

// Hole pixels [begin, end) of one row.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    std::size_t first_hole = 0;  // index of its first pixel among all hole pixels
};

// A reached pixel to copy from. One that does not exist is infinitely near and far away, so it is never chosen.
struct Candidate {
    float depth = std::numeric_limits<float>::infinity();
    int distance_px = std::numeric_limits<int>::max();
    int index = -1;  // of the pixel
};

// Ends of one surface seen at a slant differ by a few percent in depth; then the nearer end looks better.
constexpr float kSameDepthPart = 0.1F;

// The farther surface; the closer end when both are about as far. No branches: it runs on several pixels at once.
inline Candidate background_of(const Candidate& a, const Candidate& b) {
    const bool b_is_farther = b.depth < a.depth;
    const float farther_depth = b_is_farther ? b.depth : a.depth;
    const float nearer_depth = b_is_farther ? a.depth : b.depth;
    const int farther_distance_px = b_is_farther ? b.distance_px : a.distance_px;
    const int nearer_distance_px = b_is_farther ? a.distance_px : b.distance_px;
    const bool is_same_surface = nearer_depth - farther_depth <= kSameDepthPart * nearer_depth;
    const bool take_nearer = is_same_surface & (nearer_distance_px < farther_distance_px);
    const bool take_b = b_is_farther != take_nearer;
    return {take_b ? b.depth : a.depth, take_b ? b.distance_px : a.distance_px, take_b ? b.index : a.index};
}

class NearestBackgroundFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "nearest-background"; }

    void apply(DisplayFrame& frame) override {
        width_ = frame.coverage.width();
        const auto columns = static_cast<std::size_t>(width_);
        rows_.resize(columns);
        depths_.resize(columns);
        chosen_.resize(columns);
        collect_runs(frame);
        find_ends_below(frame);
        for (const HoleRun& run : runs_) {
            update_columns(frame, run, run.y - 1);
            choose(frame, run);
            copy_chosen(frame, run);
        }
        // Last, because the passes above tell holes from reached pixels by it.
        for (const HoleRun& run : runs_) {
            const auto row = frame.coverage.row(run.y);
            std::fill(row.begin() + run.begin, row.begin() + run.end, Coverage::filled);
        }
    }

private:
    static constexpr int kNone = -1;
    static constexpr Rgba8 kNothingColour{128, 128, 128, 255};  // no pixel of the hole's row and column was reached

    void collect_runs(const DisplayFrame& frame) {
        runs_.clear();
        std::size_t holes = 0;
        for (int y = 0; y < frame.coverage.height(); ++y) {
            const Coverage* coverage = frame.coverage.row(y).data();
            for (int x = next_hole(coverage, 0, width_); x < width_;) {
                HoleRun run{y, x, x, holes};
                while (run.end < width_ && coverage[run.end] == Coverage::hole) ++run.end;
                holes += static_cast<std::size_t>(run.end - run.begin);
                x = next_hole(coverage, run.end, width_);
                runs_.push_back(run);
            }
        }
        row_below_.resize(holes);
        depth_below_.resize(holes);
    }

    static int next_hole(const Coverage* coverage, int begin, int width) {
        const void* found =
            std::memchr(coverage + begin, static_cast<int>(Coverage::hole), static_cast<std::size_t>(width - begin));
        return found == nullptr ? width : static_cast<int>(static_cast<const Coverage*>(found) - coverage);
    }

    // Scanning along columns, rows_ and depths_ hold the last reached pixel of each one, where the last row that was
    // seen there is a hole. `beside` is the row that the scan comes from; outside of the image nothing is reached.
    void update_columns(const DisplayFrame& frame, const HoleRun& run, int beside) {
        int* rows = rows_.data();
        float* depths = depths_.data();
        if (beside < 0 || beside >= frame.coverage.height()) {
            std::fill(rows + run.begin, rows + run.end, kNone);
            std::fill(depths + run.begin, depths + run.end, std::numeric_limits<float>::infinity());
            return;
        }
        const Coverage* coverage_beside = frame.coverage.row(beside).data();
        const float* depth_beside = frame.depth.row(beside).data();
        for (int x = run.begin; x < run.end; ++x) {
            const bool is_reached = coverage_beside[x] != Coverage::hole;
            rows[x] = is_reached ? beside : rows[x];
            depths[x] = is_reached ? depth_beside[x] : depths[x];
        }
    }

    // Bottom row first; what is below each hole pixel is kept until the way back.
    void find_ends_below(const DisplayFrame& frame) {
        for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
            update_columns(frame, *run, run->y + 1);
            std::copy(rows_.begin() + run->begin, rows_.begin() + run->end,
                      row_below_.begin() + static_cast<std::ptrdiff_t>(run->first_hole));
            std::copy(depths_.begin() + run->begin, depths_.begin() + run->end,
                      depth_below_.begin() + static_cast<std::ptrdiff_t>(run->first_hole));
        }
    }

    // For each pixel of the run the index of the pixel it copies, in chosen_.
    void choose(const DisplayFrame& frame, const HoleRun& run) {
        const int row_index = run.y * width_;
        Candidate left;
        Candidate right;
        if (run.begin > 0) left = {frame.depth.at(run.begin - 1, run.y), 0, row_index + run.begin - 1};
        if (run.end < width_) right = {frame.depth.at(run.end, run.y), 0, row_index + run.end};
        const bool has_left = left.index >= 0;
        const bool has_right = right.index >= 0;
        constexpr int kFarAway = std::numeric_limits<int>::max();
        const int* above = rows_.data();
        const float* depth_above = depths_.data();
        const int* below = row_below_.data() + run.first_hole;
        const float* depth_below = depth_below_.data() + run.first_hole;
        for (int x = run.begin; x < run.end; ++x) {
            const int i = x - run.begin;
            left.distance_px = has_left ? i + 1 : kFarAway;
            right.distance_px = has_right ? run.end - x : kFarAway;
            const Candidate up{depth_above[x], above[x] >= 0 ? run.y - above[x] : kFarAway, above[x] * width_ + x};
            const Candidate down{depth_below[i], below[i] >= 0 ? below[i] - run.y : kFarAway, below[i] * width_ + x};
            const Candidate along_row = background_of(left, right);
            const Candidate along_column = background_of(up, down);
            const bool take_column = along_column.distance_px < along_row.distance_px;
            chosen_[static_cast<std::size_t>(x)] = take_column ? along_column.index : along_row.index;
        }
    }

    void copy_chosen(DisplayFrame& frame, const HoleRun& run) const {
        Rgba8* colours = frame.colour.pixels().data();
        float* depths = frame.depth.pixels().data();
        const std::size_t row_index = static_cast<std::size_t>(run.y) * static_cast<std::size_t>(width_);
        for (int x = run.begin; x < run.end; ++x) {
            const int from = chosen_[static_cast<std::size_t>(x)];
            const std::size_t to = row_index + static_cast<std::size_t>(x);
            colours[to] = from < 0 ? kNothingColour : colours[from];
            depths[to] = from < 0 ? 0.0F : depths[from];
        }
    }

    int width_ = 0;
    std::vector<HoleRun> runs_;  // top row first
    std::vector<int> rows_;      // per column, see update_columns()
    std::vector<float> depths_;
    std::vector<int> row_below_;  // per hole pixel: the reached row below, or kNone
    std::vector<float> depth_below_;
    std::vector<int> chosen_;  // per column, of one run
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
