#include "warp_server/fill_nearest_background.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "warp_server/fill_kernels.h"

namespace lw {
namespace {

// Hole pixels [begin, end) of one row.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    std::size_t first_hole = 0;  // index of its first pixel among all hole pixels
};

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
        if (beside < 0 || beside >= frame.coverage.height()) {
            std::fill(rows_.begin() + run.begin, rows_.begin() + run.end, kNone);
            std::fill(depths_.begin() + run.begin, depths_.begin() + run.end, std::numeric_limits<float>::infinity());
            return;
        }
        follow_columns(run.begin, run.end, beside, frame.coverage.row(beside).data(), frame.depth.row(beside).data(),
                       rows_.data(), depths_.data());
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

    // For each pixel of the run the index of the pixel it copies, into chosen_.
    void choose(const DisplayFrame& frame, const HoleRun& run) {
        FillRun input;
        input.y = run.y;
        input.begin = run.begin;
        input.end = run.end;
        input.width = width_;
        const int row_index = run.y * width_;
        if (run.begin > 0) input.left = {frame.depth.at(run.begin - 1, run.y), row_index + run.begin - 1};
        if (run.end < width_) input.right = {frame.depth.at(run.end, run.y), row_index + run.end};
        input.row_above = rows_.data() + run.begin;
        input.depth_above = depths_.data() + run.begin;
        input.row_below = row_below_.data() + run.first_hole;
        input.depth_below = depth_below_.data() + run.first_hole;
        choose_background(input, chosen_.data());
    }

    void copy_chosen(DisplayFrame& frame, const HoleRun& run) const {
        Rgba8* colours = frame.colour.pixels().data();
        float* depths = frame.depth.pixels().data();
        const std::size_t row_index = static_cast<std::size_t>(run.y) * static_cast<std::size_t>(width_);
        for (int x = run.begin; x < run.end; ++x) {
            const int from = chosen_[static_cast<std::size_t>(x - run.begin)];
            const std::size_t to = row_index + static_cast<std::size_t>(x);
            colours[to] = from < 0 ? kNothingColour : colours[from];
            depths[to] = from < 0 ? 0.0F : depths[from];
        }
    }

    int width_ = 0;
    std::vector<HoleRun> runs_;       // top row first
    std::vector<std::int32_t> rows_;  // per column, see update_columns()
    std::vector<float> depths_;
    std::vector<std::int32_t> row_below_;  // per hole pixel: the reached row below, or kNone
    std::vector<float> depth_below_;
    std::vector<std::int32_t> chosen_;  // of one run
};

}  // namespace

std::unique_ptr<Fill> make_nearest_background_fill() { return std::make_unique<NearestBackgroundFill>(); }

}  // namespace lw
