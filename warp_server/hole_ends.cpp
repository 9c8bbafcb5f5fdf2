#include "warp_server/hole_ends.h"

#include <algorithm>
#include <cstring>

namespace lw {
namespace {

constexpr int kBandsPerThread = 2;  // of rows: holes are not spread evenly
constexpr int kShareStep_px = 64;   // a line of coverage, and a whole number of any vector
constexpr int kRunWork_px = 32;     // a run takes as long as so many pixels of a long one

int next_hole(const Coverage* coverage, int begin, int width) {
    const void* found =
        std::memchr(coverage + begin, static_cast<int>(Coverage::hole), static_cast<std::size_t>(width - begin));
    return found == nullptr ? width : static_cast<int>(static_cast<const Coverage*>(found) - coverage);
}

}  // namespace

void HoleEnds::find(const DisplayFrame& frame, TaskPool* threads) {
    width_ = frame.coverage.width();
    frame_ = &frame;
    collect_runs(threads);
    count_columns(frame.coverage.height());
}

void HoleEnds::collect_runs(TaskPool* threads) {
    const int tasks = threads == nullptr ? 1 : kBandsPerThread * threads->threads();
    rows_.resize(static_cast<std::size_t>(tasks));
    if (threads == nullptr) {
        collect_rows_(0, 0);
    } else {
        threads->run(tasks, collect_rows_);
    }
    runs_.clear();
    for (const std::vector<HoleRun>& runs : rows_) runs_.insert(runs_.end(), runs.begin(), runs.end());
}

void HoleEnds::collect_runs(RowRange rows, std::vector<HoleRun>& into) const {
    into.clear();
    for (int y = rows.begin; y < rows.end; ++y) {
        const Coverage* coverage = frame_->coverage.row(y).data();
        for (int x = next_hole(coverage, 0, width_); x < width_;) {
            HoleRun run{y, x, x};
            while (run.end < width_ && coverage[run.end] == Coverage::hole) ++run.end;
            x = next_hole(coverage, run.end, width_);
            into.push_back(run);
        }
    }
}

void HoleEnds::count_columns(int height) {
    const auto columns = static_cast<std::size_t>(width_);
    // First by how much it changes from column to column, then how much it is.
    holes_.assign(columns + 1, 0);
    work_until_.assign(columns + 1, 0.0F);
    hole_count_ = 0;
    for (const HoleRun& run : runs_) {
        ++holes_[static_cast<std::size_t>(run.begin)];
        --holes_[static_cast<std::size_t>(run.end)];
        work_until_[static_cast<std::size_t>(run.begin) + 1] += static_cast<float>(kRunWork_px);
        hole_count_ += static_cast<std::size_t>(run.end - run.begin);
    }
    unreached_columns_.clear();
    int holes = 0;
    for (int x = 0; x < width_; ++x) {
        const auto i = static_cast<std::size_t>(x);
        holes += holes_[i];
        work_until_[i + 1] += work_until_[i] + static_cast<float>(holes);
        if (holes < height) continue;
        if (unreached_columns_.empty() || unreached_columns_.back().end != x) unreached_columns_.push_back({x, x});
        unreached_columns_.back().end = x + 1;
    }
}

RowRange HoleEnds::share(int index, int count) const {
    const RowRange exact = band_of_cost(work_until_, index, count);
    const auto rounded = [&](int x) {
        return x >= width_ ? width_ : std::min((x + kShareStep_px / 2) / kShareStep_px * kShareStep_px, width_);
    };
    return {rounded(exact.begin), rounded(exact.end)};
}

void HoleEnds::parts_in(RowRange columns, std::vector<HolePart>& parts) const {
    // Without a branch: whether a run meets the columns nobody foresees.
    parts.resize(runs_.size() + 1);
    std::size_t count = 0;
    for (const HoleRun& run : runs_) {
        const RowRange meet{std::max(run.begin, columns.begin), std::min(run.end, columns.end)};
        parts[count] = {run, meet};
        count += meet.begin < meet.end ? 1 : 0;
    }
    parts.resize(count);
}

}  // namespace lw
