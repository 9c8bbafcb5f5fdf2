#pragma once
/// The holes of a picture as runs along rows, and how threads share them.

#include <cstddef>
#include <span>
#include <vector>

#include "core/task_pool.h"
#include "warp_server/fill_kernels.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/warp_method.h"

namespace lw {

/// No allocation once sizes are seen. Its cost grows with the holes, not with the picture. One thread at a time finds;
/// then any number may read.
class HoleEnds {
public:
    /// Fewer are filled before another thread has woken.
    static constexpr std::size_t kWorthThreads = 4096;

    HoleEnds() = default;
    HoleEnds(const HoleEnds&) = delete;
    HoleEnds& operator=(const HoleEnds&) = delete;

    /// @param threads  null: the caller's alone
    void find(const DisplayFrame& frame, TaskPool* threads = nullptr);

    /// Top row first, from left to right.
    [[nodiscard]] std::span<const HoleRun> runs() const { return runs_; }
    [[nodiscard]] std::size_t hole_count() const { return hole_count_; }
    /// All columns of the picture.
    [[nodiscard]] RowRange columns() const { return {0, width_}; }
    /// Share `index` of `count` of the columns, of about as much work: walks along columns (fill_kernels.h) do not
    /// meet.
    [[nodiscard]] RowRange share(int index, int count) const;

    /// The parts of the runs in these columns, top row first.
    void parts_in(RowRange columns, std::vector<HolePart>& parts) const;

    /// Where neither a row nor a column has any reached pixel, choose_background() finds nothing; what it found for the
    /// closest column is shown there. Calls copy(y, column, from_column) for each such pixel, after all others have
    /// theirs; for none in a picture of nothing but holes.
    template <class Copy>
    void spread_sideways(const Copy& copy) const {
        for (const HoleRun& run : runs_) {
            if (run.end - run.begin < width_) continue;
            for (const RowRange& gap : unreached_columns_) {
                const int middle = gap.begin == 0 ? gap.begin : gap.end == width_ ? gap.end : (gap.begin + gap.end) / 2;
                if (gap.end - gap.begin == width_) return;
                for (int x = gap.begin; x < middle; ++x) copy(run.y, x, gap.begin - 1);
                for (int x = middle; x < gap.end; ++x) copy(run.y, x, gap.end);
            }
        }
    }

private:
    void collect_runs(TaskPool* threads);
    void collect_runs(RowRange rows, std::vector<HoleRun>& into) const;
    void count_columns(int height);

    int width_ = 0;
    std::size_t hole_count_ = 0;
    std::vector<HoleRun> runs_;
    std::vector<std::vector<HoleRun>> rows_;   // runs by task: bands of the picture
    std::vector<RowRange> unreached_columns_;  // columns of nothing but holes
    std::vector<int> holes_;                   // by column
    std::vector<float> work_until_;            // of all columns before
    const DisplayFrame* frame_ = nullptr;
    // Kept, because making a function object may allocate.
    TaskPool::Work collect_rows_ = [this](int task, int /*worker*/) {
        const int height = frame_->coverage.height();
        collect_runs(band_of_rows(height, task, static_cast<int>(rows_.size())), rows_[static_cast<std::size_t>(task)]);
    };
};

}  // namespace lw
