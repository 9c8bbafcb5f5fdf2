#pragma once
/// What tiles get of a frame's budget before the view takes the rest: a dense view would leave them nothing.

#include <span>

#include "client_renderer/shell_budget.h"

namespace lw {

/// One thread.
class TileSavings {
public:
    /// A frame with so much time begins: a part of it is saved.
    void save(double budget_ms);
    /// Tiles took so much.
    void spend(double cost_ms);
    /// What tiles need in this frame: those that are worth more than a denser view, or as many as were saved up for.
    /// @param tiles  by item, without a gap
    [[nodiscard]] double needed_ms(std::span<const DrawCandidate> tiles, const BudgetSettings& budget) const;

private:
    double saved_ms_ = 0.0;
};

}  // namespace lw
