#include "client_renderer/tile_savings.h"

#include <algorithm>

namespace lw {
namespace {

// Of the budget, at most: for tiles that are worth more than a denser view, and for those that were saved up for.
constexpr double kMostForTiles = 0.4;
// Of the budget: saved up in every frame for tiles that are worth less. With half of it tiles beside new ones grew so
// old that gaps opened between them (0.65 % of the pictures of both eyes on a walk through a room, now 0.45 %).
constexpr double kSavedForTiles = 0.10;
// What a denser view puts right: in `city` at 512x512 FLIP falls by 0.003 from density 1.5 to 2, as if 2000 pixels were
// no longer wrong, for 87 ms.
constexpr double kDenserView_px_per_ms = 25.0;

double worth_more_ms(std::span<const DrawCandidate> tiles, double most_ms) {
    double sum_ms = 0.0;
    for (const DrawCandidate& tile : tiles) {
        const bool fits = sum_ms + tile.cost_ms <= most_ms;
        if (fits && tile.priority > kDenserView_px_per_ms * tile.cost_ms) sum_ms += tile.cost_ms;
    }
    return sum_ms;
}

}  // namespace

void TileSavings::save(double budget_ms) {
    saved_ms_ = std::min(saved_ms_ + kSavedForTiles * budget_ms, kMostForTiles * budget_ms);
}

void TileSavings::spend(double cost_ms) { saved_ms_ = std::max(saved_ms_ - cost_ms, 0.0); }

double TileSavings::needed_ms(std::span<const DrawCandidate> tiles, const BudgetSettings& budget) const {
    const double most_ms = kMostForTiles * budget.budget_ms;
    BudgetSettings saved = budget;
    saved.budget_ms = std::min(saved_ms_, most_ms);
    double saved_for_ms = 0.0;
    for (const std::size_t item : choose_items({tiles.begin(), tiles.end()}, saved)) {
        saved_for_ms += tiles[item - tiles.front().item].cost_ms;
    }
    return std::max(worth_more_ms(tiles, most_ms), saved_for_ms);
}

}  // namespace lw
