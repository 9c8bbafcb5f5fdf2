#include "warp_server/fill_nearest_background.h"

#include <cstring>
#include <limits>

namespace lw {
namespace {

constexpr int kNone = -1;

// Hole pixels [begin, end) of one row.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    std::size_t first_hole = 0;  // index of its first pixel among all hole pixels
};

// A place to copy from and how far away it is.
struct Candidate {
    int x = kNone;
    int y = kNone;
    int distance_px = std::numeric_limits<int>::max();
    float depth = 0.0F;
    [[nodiscard]] bool exists() const { return x != kNone; }
};

// Ends of one surface seen at a slant differ by a few percent in depth; then the nearer end looks better.
constexpr float kSameDepthPart = 0.1F;

// The farther surface; the closer end when both are about as far.
Candidate background_of(const Candidate& a, const Candidate& b) {
    if (!a.exists() || !b.exists()) return a.exists() ? a : b;
    const Candidate& farther = b.depth < a.depth ? b : a;
    const Candidate& nearer = b.depth < a.depth ? a : b;
    const bool same_surface = nearer.depth - farther.depth <= kSameDepthPart * nearer.depth;
    return same_surface && nearer.distance_px < farther.distance_px ? nearer : farther;
}

class NearestBackgroundFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "nearest-background"; }

    void apply(DisplayFrame& frame) override {
        collect_runs(frame);
        find_ends_below(frame);
        for (std::size_t hole = 0; hole < chosen_index_.size(); ++hole) {
            const std::size_t index = hole_index_[hole];
            const std::size_t from = chosen_index_[hole];
            frame.coverage.pixels()[index] = Coverage::filled;
            frame.colour.pixels()[index] = from == kNothing ? kNothingColour : frame.colour.pixels()[from];
            frame.depth.pixels()[index] = from == kNothing ? 0.0F : frame.depth.pixels()[from];
        }
    }

private:
    static constexpr std::size_t kNothing = std::numeric_limits<std::size_t>::max();
    static constexpr Rgba8 kNothingColour{128, 128, 128, 255};  // no pixel of the hole's row and column was reached

    // Runs of hole pixels, top row first, and for each hole pixel the reached row above it.
    void collect_runs(const DisplayFrame& frame) {
        runs_.clear();
        hole_index_.clear();
        row_above_.clear();
        row_of_column_.assign(static_cast<std::size_t>(frame.coverage.width()), kNone);
        const int width = frame.coverage.width();
        for (int y = 0; y < frame.coverage.height(); ++y) {
            const Coverage* coverage = frame.coverage.row(y).data();
            for (int x = next_hole(coverage, 0, width); x < width;) {
                HoleRun run{y, x, x, hole_index_.size()};
                for (; run.end < width && coverage[run.end] == Coverage::hole; ++run.end) add_hole(frame, run.end, y);
                x = next_hole(coverage, run.end, width);
                runs_.push_back(run);
            }
        }
    }

    static int next_hole(const Coverage* coverage, int begin, int width) {
        const void* found =
            std::memchr(coverage + begin, static_cast<int>(Coverage::hole), static_cast<std::size_t>(width - begin));
        return found == nullptr ? width : static_cast<int>(static_cast<const Coverage*>(found) - coverage);
    }

    void add_hole(const DisplayFrame& frame, int x, int y) {
        int& above = row_of_column_[static_cast<std::size_t>(x)];
        if (y == 0) {
            above = kNone;
        } else if (frame.coverage.at(x, y - 1) != Coverage::hole) {
            above = y - 1;
        }
        row_above_.push_back(above);
        hole_index_.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.coverage.width()) +
                              static_cast<std::size_t>(x));
    }

    // Bottom row first, so that the reached row below each hole pixel is known; then all four ends are.
    void find_ends_below(const DisplayFrame& frame) {
        chosen_index_.assign(hole_index_.size(), kNothing);
        const int last_row = frame.coverage.height() - 1;
        for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
            for (int x = run->begin; x < run->end; ++x) {
                int& below = row_of_column_[static_cast<std::size_t>(x)];
                if (run->y == last_row) {
                    below = kNone;
                } else if (frame.coverage.at(x, run->y + 1) != Coverage::hole) {
                    below = run->y + 1;
                }
                const std::size_t hole = run->first_hole + static_cast<std::size_t>(x - run->begin);
                chosen_index_[hole] = choose(frame, *run, x, row_above_[hole], below);
            }
        }
    }

    static Candidate candidate(const DisplayFrame& frame, int x, int y, int distance_px) {
        return {x, y, distance_px, frame.depth.at(x, y)};
    }

    static std::size_t choose(const DisplayFrame& frame, const HoleRun& run, int x, int above, int below) {
        Candidate left;
        Candidate right;
        Candidate up;
        Candidate down;
        if (run.begin > 0) left = candidate(frame, run.begin - 1, run.y, x - run.begin + 1);
        if (run.end < frame.coverage.width()) right = candidate(frame, run.end, run.y, run.end - x);
        if (above != kNone) up = candidate(frame, x, above, run.y - above);
        if (below != kNone) down = candidate(frame, x, below, below - run.y);
        const Candidate along_row = background_of(left, right);
        const Candidate along_column = background_of(up, down);
        const Candidate& best = along_column.distance_px < along_row.distance_px ? along_column : along_row;
        if (!best.exists()) return kNothing;
        return static_cast<std::size_t>(best.y) * static_cast<std::size_t>(frame.coverage.width()) +
               static_cast<std::size_t>(best.x);
    }

    std::vector<HoleRun> runs_;
    std::vector<std::size_t> hole_index_;    // pixel index of each hole pixel, in reading order
    std::vector<int> row_above_;             // of each hole pixel: the reached row above, or kNone
    std::vector<int> row_of_column_;         // while scanning: of each column the last reached row beside a hole
    std::vector<std::size_t> chosen_index_;  // of each hole pixel: where its colour comes from
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
