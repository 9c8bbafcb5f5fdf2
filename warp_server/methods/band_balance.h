#pragma once
/// Sharing a picture among threads so that they are done at the same time: estimates of what rows cost are a quarter
/// off where the view is difficult, but off in the next picture as in the last.

#include <span>
#include <vector>

#include "warp_server/methods/row_range.h"

namespace lw {

/// Cuts pictures into bands by estimated costs, and learns from the times the bands took. One thread.
class BandBalance {
public:
    /// Cuts a picture into bands.size() bands, >= 1.
    /// @param cost_until  estimated cost of all rows before each row, and of all; ascending
    void cut(std::span<const float> cost_until, std::span<RowRange> bands);

    /// What each band of the last cut() took; in any unit. Nothing is learnt where they took no time.
    void learn(std::span<const double> times);

    /// A thread may have waited for its processor: what one picture teaches moves a border by a part of what it says,
    /// and by no more than this share of the picture.
    static constexpr double kTaughtPart = 0.3;
    static constexpr double kLargestStep = 0.03;

private:
    std::vector<double> ends_;     // of each band, as a share of the estimated cost; the last is 1
    std::vector<double> learned_;  // the same after learn()
};

}  // namespace lw
