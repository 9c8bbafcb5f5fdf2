#include "client_renderer/shell_priority.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace lw {

const char* PredictedError::reason() const {
    const std::pair<double, const char*> terms[] = {{missing, "missing"},     {parallax, "parallax"}, {torn, "torn"},
                                                    {resampled, "resampled"}, {movers, "movers"},     {holes, "holes"}};
    const auto* largest = std::max_element(terms, terms + std::size(terms),
                                           [](const auto& a, const auto& b) { return a.first < b.first; });
    return largest->first > 0.0 ? largest->second : "";
}

PredictedError predicted_error(const ItemOutlook& item, const PriorityWeights& weights) {
    PredictedError error;
    if (!item.drawn) {
        error.missing = item.display_px;
        return error;
    }
    error.missing = item.beyond_edge_share * item.display_px;
    if (item.display_px > 0.0) {
        const double opened = item.gap_px_per_m * item.eye_moved_m / item.display_px;
        error.parallax = weights.parallax * item.display_px * (1.0 - std::exp(-opened));
    }
    if (item.overlap_m > 0.0) {
        error.torn = weights.parallax * item.display_px * std::clamp(item.eye_moved_m / item.overlap_m - 1.0, 0.0, 1.0);
    }
    error.resampled = item.display_px * std::min(weights.resampled * item.eye_moved_m / item.typical_m, 1.0);
    error.movers = weights.movers * item.mover_px * item.age_s;
    error.holes = weights.measured * item.measured_holes_px;
    return error;
}

double periphery_falloff(double off_axis_rad, const PriorityWeights& weights) {
    return off_axis_rad <= weights.b1_rad ? 1.0 : std::exp(-(off_axis_rad - weights.b1_rad) / weights.c1_rad);
}

double error_weight(const ItemOutlook& item, const PriorityWeights& weights) {
    const double first = (item.manipulated ? weights.manipulated : 1.0) * (item.is_view ? weights.view : 1.0);
    if (!weights.human_factors) return first * std::max(item.visible_share, weights.out_of_view);
    const double in_view = item.visible_share * periphery_falloff(item.off_axis_rad, weights);
    // Behind the head an item still counts a little, the less the farther it is to turn there.
    const double behind = weights.out_of_view * periphery_falloff(item.off_axis_rad, weights);
    return first * std::max(in_view, behind);
}

}  // namespace lw
