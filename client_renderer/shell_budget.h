#pragma once
/// Which items are drawn in a frame: by value per cost, within the app's time budget.

#include <cstddef>
#include <optional>
#include <vector>

namespace lw {

/// Costs of items as they were measured, smoothed. One thread.
class CostBook {
public:
    explicit CostBook(std::size_t items) : costs_ms_(items) {}

    void learn(std::size_t item, double measured_ms);
    /// What drawing the item is expected to cost; `guess_ms` while it was never drawn.
    [[nodiscard]] double expected_ms(std::size_t item, double guess_ms) const {
        return costs_ms_[item].value_or(guess_ms);
    }
    [[nodiscard]] bool knows(std::size_t item) const { return costs_ms_[item].has_value(); }

private:
    std::vector<std::optional<double>> costs_ms_;
};

struct BudgetSettings {
    double budget_ms = 0.0;       ///< for all items of a frame, >= 0
    double least_error_px = 1.0;  ///< an item that will be wrong in fewer display pixels, as weighted, is valid
    double max_age_s = 4.0;       ///< an item that has been wrong for longer comes before all that have not
};

/// One item that could be drawn.
struct DrawCandidate {
    std::size_t item = 0;
    double priority = 0.0;   ///< weighted display pixels (shell_priority.h)
    double cost_ms = 0.0;    ///< expected, > 0
    double waiting_s = 0.0;  ///< since it became invalid, or since it was last drawn
};

/// Items to draw, in the order of drawing. Items below least_error_px are valid and left alone. Those that have waited
/// longer than max_age_s come first, the longest first; then the others by priority per cost, equal ones by number.
/// Each is taken if it fits into what is left of the budget. When not even the first fits, because it alone costs more,
/// it is taken alone if it is overdue: so nothing starves, and a budget that is too small for one item is overrun once
/// per max_age_s and item. Pure, any thread.
[[nodiscard]] std::vector<std::size_t> choose_items(const std::vector<DrawCandidate>& candidates,
                                                    const BudgetSettings& settings);

/// Milliseconds that a draw is modelled to take, for runs that must not depend on the machine (`replay`). Fitted on a
/// software GL: 0.11 us per triangle, 0.04 us per sample, and 0.10 us more per sample that a surface covers.
/// @param samples          of the whole picture
/// @param covered_samples  of those, that show something
[[nodiscard]] double modelled_cost_ms(double triangles, double samples, double covered_samples);

}  // namespace lw
