#pragma once
/// The holes of a picture as runs along rows, and for each hole pixel the reached pixel that best continues behind it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/task_pool.h"
#include "warp_server/fill_kernels.h"
#include "warp_server/methods/row_range.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Hole pixels [begin, end) of one row.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    std::size_t first_hole = 0;  ///< index of its first pixel among all hole pixels, row by row
};

/// What one thread needs to look for backgrounds; keeps its memory.
struct HoleScratch {
    std::vector<std::int32_t> chosen;
    std::vector<std::int32_t> cost;
};

/// One entry for each pixel of a run; valid until the scratch is used again.
struct HoleBackground {
    std::span<const std::int32_t> index;  ///< of the pixel in the picture that continues behind it
    std::span<const std::int32_t>
        cost;  ///< of its distance (choose_background()); larger than any other where it is a guess
};

/// No allocation once sizes are seen. Its cost grows with the holes, not with the picture. One thread at a time finds;
/// then any number may ask for backgrounds, each with a scratch of its own.
class HoleEnds {
public:
    /// Fewer are filled before another thread has woken.
    static constexpr std::size_t kWorthThreads = 4096;

    HoleEnds() = default;
    HoleEnds(const HoleEnds&) = delete;
    HoleEnds& operator=(const HoleEnds&) = delete;

    /// Finds the runs, top row first, and what lies above and below each hole pixel.
    /// @param threads  null: the caller's alone
    void find(const DisplayFrame& frame, TaskPool* threads = nullptr);

    [[nodiscard]] std::span<const HoleRun> runs() const { return runs_; }
    [[nodiscard]] std::size_t hole_count() const { return hole_count_; }
    /// Share `index` of `count` of the runs, of about equally many holes.
    [[nodiscard]] std::span<const HoleRun> share(int index, int count) const;

    /// For each pixel of the run what continues behind it: along its row and column the farther surface
    /// (choose_background()); where neither row nor column was reached that of the closest hole of its row that has
    /// one. -1 only in a picture of nothing but holes. Depths of reached pixels are those of find().
    [[nodiscard]] HoleBackground background_of(const DisplayFrame& frame, const HoleRun& run, HoleScratch& scratch,
                                               const FillCosts& costs = {}) const;

private:
    // What ends the columns of hole pixels on one side.
    struct ColumnEnds {
        std::vector<std::int32_t> row;  // per hole pixel: the reached row on that side, or -1
        std::vector<float> depth;
        std::vector<std::int32_t> rows;  // per column, see follow()
        std::vector<float> depths;
    };

    // Hole runs of some rows, and how many pixels they are.
    struct Rows {
        std::vector<HoleRun> runs;  // first_hole counts from the first of these
        std::size_t hole_count = 0;
    };

    void collect_runs(TaskPool* threads);
    void collect_runs(RowRange rows, Rows& into) const;
    void join_rows();
    void find_ends_above(const DisplayFrame& frame);
    void find_ends_below(const DisplayFrame& frame);
    static void follow(const DisplayFrame& frame, const HoleRun& run, int beside, ColumnEnds& ends);

    int width_ = 0;
    std::size_t hole_count_ = 0;
    std::vector<HoleRun> runs_;  // top row first
    std::vector<Rows> rows_;     // by task: bands of the picture
    ColumnEnds above_;
    ColumnEnds below_;
    const DisplayFrame* frame_ = nullptr;
    // Kept, because making a function object may allocate.
    TaskPool::Work collect_rows_ = [this](int task, int /*worker*/) {
        const int height = frame_->coverage.height();
        collect_runs(band_of_rows(height, task, static_cast<int>(rows_.size())), rows_[static_cast<std::size_t>(task)]);
    };
    TaskPool::Work find_ends_ = [this](int task, int /*worker*/) {
        task == 0 ? find_ends_above(*frame_) : find_ends_below(*frame_);
    };
};

}  // namespace lw
