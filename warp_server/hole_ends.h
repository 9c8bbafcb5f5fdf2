#pragma once
/// The holes of a picture as runs along rows, and for each hole pixel the reached pixel that best continues behind it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "warp_server/fill_kernels.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Hole pixels [begin, end) of one row.
struct HoleRun {
    int y = 0;
    int begin = 0;
    int end = 0;
    std::size_t first_hole = 0;  ///< index of its first pixel among all hole pixels, row by row
};

/// One entry for each pixel of a run; valid until the next one is asked for.
struct HoleBackground {
    std::span<const std::int32_t> index;  ///< of the pixel in the picture that continues behind it
    std::span<const std::int32_t>
        cost;  ///< of its distance (choose_background()); larger than any other where it is a guess
};

/// Owns its scratch memory; no allocation once sizes are seen. Its cost grows with the holes, not with the picture.
/// One thread at a time.
class HoleEnds {
public:
    /// Finds the runs, top row first, and what lies below each hole pixel.
    void find(const DisplayFrame& frame);

    [[nodiscard]] std::span<const HoleRun> runs() const { return runs_; }
    [[nodiscard]] std::size_t hole_count() const { return row_below_.size(); }

    /// For each pixel of the run what continues behind it: along its row and column the farther surface
    /// (choose_background()); where neither row nor column was reached that of the closest hole of its row that has
    /// one. -1 only in a picture of nothing but holes. Runs must be asked for in the order of runs(), once each after
    /// find(), and the picture's coverage must not change in between; colours and depths of holes may.
    [[nodiscard]] HoleBackground background_of(const DisplayFrame& frame, const HoleRun& run,
                                               const FillCosts& costs = {});

private:
    void collect_runs(const DisplayFrame& frame);
    void update_columns(const DisplayFrame& frame, const HoleRun& run, int beside);
    void find_ends_below(const DisplayFrame& frame);

    int width_ = 0;
    std::vector<HoleRun> runs_;       // top row first
    std::vector<std::int32_t> rows_;  // per column, see update_columns()
    std::vector<float> depths_;
    std::vector<std::int32_t> row_below_;  // per hole pixel: the reached row below, or -1
    std::vector<float> depth_below_;
    std::vector<std::int32_t> chosen_;  // of one run
    std::vector<std::int32_t> costs_;
};

}  // namespace lw
