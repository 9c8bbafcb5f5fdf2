#include "warp_server/hole_ends.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace lw {
namespace {

constexpr int kNone = -1;

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

void HoleEnds::find(const DisplayFrame& frame) {
    width_ = frame.coverage.width();
    const auto columns = static_cast<std::size_t>(width_);
    rows_.resize(columns);
    depths_.resize(columns);
    chosen_.resize(columns);
    costs_.resize(columns);
    collect_runs(frame);
    find_ends_below(frame);
}

void HoleEnds::collect_runs(const DisplayFrame& frame) {
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

// Scanning along columns, rows_ and depths_ hold the last reached pixel of each one, where the last row that was
// seen there is a hole. `beside` is the row that the scan comes from; outside of the image nothing is reached.
void HoleEnds::update_columns(const DisplayFrame& frame, const HoleRun& run, int beside) {
    if (beside < 0 || beside >= frame.coverage.height()) {
        std::fill(rows_.begin() + run.begin, rows_.begin() + run.end, kNone);
        std::fill(depths_.begin() + run.begin, depths_.begin() + run.end, std::numeric_limits<float>::infinity());
        return;
    }
    follow_columns(run.begin, run.end, beside, frame.coverage.row(beside).data(), frame.depth.row(beside).data(),
                   rows_.data(), depths_.data());
}

// Bottom row first; what is below each hole pixel is kept until the way back.
void HoleEnds::find_ends_below(const DisplayFrame& frame) {
    for (auto run = runs_.rbegin(); run != runs_.rend(); ++run) {
        update_columns(frame, *run, run->y + 1);
        std::copy(rows_.begin() + run->begin, rows_.begin() + run->end,
                  row_below_.begin() + static_cast<std::ptrdiff_t>(run->first_hole));
        std::copy(depths_.begin() + run->begin, depths_.begin() + run->end,
                  depth_below_.begin() + static_cast<std::ptrdiff_t>(run->first_hole));
    }
}

HoleBackground HoleEnds::background_of(const DisplayFrame& frame, const HoleRun& run, const FillCosts& costs) {
    update_columns(frame, run, run.y - 1);
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
    input.costs = costs;
    choose_background(input, chosen_.data(), costs_.data());
    const std::span<std::int32_t> chosen{chosen_.data(), static_cast<std::size_t>(run.end - run.begin)};
    // A row without any reached pixel is one run; only there can a column be missing too.
    if (run.begin == 0 && run.end == width_) spread_sideways(chosen);
    return {chosen, {costs_.data(), chosen.size()}};
}

}  // namespace lw
