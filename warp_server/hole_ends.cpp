#include "warp_server/hole_ends.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace lw {
namespace {

constexpr int kNone = -1;
constexpr int kBandsPerThread = 2;  // of rows: holes are not spread evenly

int next_hole(const Coverage* coverage, int begin, int width) {
    const void* found =
        std::memchr(coverage + begin, static_cast<int>(Coverage::hole), static_cast<std::size_t>(width - begin));
    return found == nullptr ? width : static_cast<int>(static_cast<const Coverage*>(found) - coverage);
}

// Pixels without a value take that of the closest one beside them that has one.
void spread_sideways(std::span<std::int32_t> chosen) {
    const auto count = static_cast<std::ptrdiff_t>(chosen.size());
    const auto has_one = [](std::int32_t index) { return index >= 0; };
    std::ptrdiff_t gap = std::find_if_not(chosen.begin(), chosen.end(), has_one) - chosen.begin();
    while (gap < count) {
        const std::ptrdiff_t end = std::find_if(chosen.begin() + gap, chosen.end(), has_one) - chosen.begin();
        const std::int32_t left = gap > 0 ? chosen[static_cast<std::size_t>(gap - 1)] : kNone;
        const std::int32_t right = end < count ? chosen[static_cast<std::size_t>(end)] : kNone;
        const std::ptrdiff_t middle = left < 0 ? gap : right < 0 ? end : (gap + end) / 2;
        std::fill(chosen.begin() + gap, chosen.begin() + middle, left);
        std::fill(chosen.begin() + middle, chosen.begin() + end, right);
        gap = std::find_if_not(chosen.begin() + end, chosen.end(), has_one) - chosen.begin();
    }
}

}  // namespace

void HoleEnds::find(const DisplayFrame& frame, TaskPool* threads) {
    width_ = frame.coverage.width();
    frame_ = &frame;
    collect_runs(threads);
    for (ColumnEnds* ends : {&above_, &below_}) {
        ends->row.resize(hole_count_);
        ends->depth.resize(hole_count_);
        ends->rows.resize(static_cast<std::size_t>(width_));
        ends->depths.resize(static_cast<std::size_t>(width_));
    }
    if (threads != nullptr && hole_count_ >= kWorthThreads) return threads->run(2, find_ends_);
    find_ends_above(frame);
    find_ends_below(frame);
}

void HoleEnds::collect_runs(TaskPool* threads) {
    const int tasks = threads == nullptr ? 1 : kBandsPerThread * threads->threads();
    rows_.resize(static_cast<std::size_t>(tasks));
    if (threads == nullptr) {
        collect_rows_(0, 0);
    } else {
        threads->run(tasks, collect_rows_);
    }
    join_rows();
}

void HoleEnds::collect_runs(RowRange rows, Rows& into) const {
    into.runs.clear();
    into.hole_count = 0;
    for (int y = rows.begin; y < rows.end; ++y) {
        const Coverage* coverage = frame_->coverage.row(y).data();
        for (int x = next_hole(coverage, 0, width_); x < width_;) {
            HoleRun run{y, x, x, into.hole_count};
            while (run.end < width_ && coverage[run.end] == Coverage::hole) ++run.end;
            into.hole_count += static_cast<std::size_t>(run.end - run.begin);
            x = next_hole(coverage, run.end, width_);
            into.runs.push_back(run);
        }
    }
}

void HoleEnds::join_rows() {
    runs_.clear();
    hole_count_ = 0;
    for (const Rows& rows : rows_) {
        for (HoleRun run : rows.runs) {
            run.first_hole += hole_count_;
            runs_.push_back(run);
        }
        hole_count_ += rows.hole_count;
    }
}

// Along columns one pixel follows from the one beside it, so each side is one thread's.
void HoleEnds::find_ends_above(const DisplayFrame& frame) {
    for (const HoleRun& run : runs_) follow(frame, run, run.y - 1, above_);
}

void HoleEnds::find_ends_below(const DisplayFrame& frame) {
    for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) follow(frame, *run, run->y + 1, below_);
}

// While a scan goes along columns, `rows` and `depths` hold the last reached pixel of each one, where the last row that
// was seen there is a hole. `beside` is the row that the scan comes from; outside of the image nothing is reached.
void HoleEnds::follow(const DisplayFrame& frame, const HoleRun& run, int beside, ColumnEnds& ends) {
    if (beside < 0 || beside >= frame.coverage.height()) {
        std::fill(ends.rows.begin() + run.begin, ends.rows.begin() + run.end, kNone);
        std::fill(ends.depths.begin() + run.begin, ends.depths.begin() + run.end,
                  std::numeric_limits<float>::infinity());
    } else {
        follow_columns(run.begin, run.end, beside, frame.coverage.row(beside).data(), frame.depth.row(beside).data(),
                       ends.rows.data(), ends.depths.data());
    }
    std::copy(ends.rows.begin() + run.begin, ends.rows.begin() + run.end,
              ends.row.begin() + static_cast<std::ptrdiff_t>(run.first_hole));
    std::copy(ends.depths.begin() + run.begin, ends.depths.begin() + run.end,
              ends.depth.begin() + static_cast<std::ptrdiff_t>(run.first_hole));
}

std::span<const HoleRun> HoleEnds::share(int index, int count) const {
    const auto first_of = [&](int part) {
        const std::size_t hole = hole_count_ * static_cast<std::size_t>(part) / static_cast<std::size_t>(count);
        return static_cast<std::size_t>(std::ranges::lower_bound(runs_, hole, {}, &HoleRun::first_hole) -
                                        runs_.begin());
    };
    const std::size_t first = first_of(index);
    return std::span{runs_}.subspan(first, first_of(index + 1) - first);
}

HoleBackground HoleEnds::background_of(const DisplayFrame& frame, const HoleRun& run, HoleScratch& scratch,
                                       const FillCosts& costs) const {
    if (scratch.chosen.size() < static_cast<std::size_t>(width_)) {
        scratch.chosen.resize(static_cast<std::size_t>(width_));
        scratch.cost.resize(static_cast<std::size_t>(width_));
    }
    FillRun input;
    input.y = run.y;
    input.begin = run.begin;
    input.end = run.end;
    input.width = width_;
    const int row_index = run.y * width_;
    if (run.begin > 0) input.left = {frame.depth.at(run.begin - 1, run.y), row_index + run.begin - 1};
    if (run.end < width_) input.right = {frame.depth.at(run.end, run.y), row_index + run.end};
    input.row_above = above_.row.data() + run.first_hole;
    input.depth_above = above_.depth.data() + run.first_hole;
    input.row_below = below_.row.data() + run.first_hole;
    input.depth_below = below_.depth.data() + run.first_hole;
    input.costs = costs;
    choose_background(input, scratch.chosen.data(), scratch.cost.data());
    const std::span<std::int32_t> chosen{scratch.chosen.data(), static_cast<std::size_t>(run.end - run.begin)};
    // A row without any reached pixel is one run; only there can a column be missing too.
    if (run.begin == 0 && run.end == width_) spread_sideways(chosen);
    return {chosen, {scratch.cost.data(), chosen.size()}};
}

}  // namespace lw
