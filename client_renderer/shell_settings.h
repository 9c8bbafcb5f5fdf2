#pragma once
/// The knobs of a client that draws in shells, as the command line names them.

#include <optional>

#include "client_renderer/shell_priority.h"
#include "core/clock.h"

namespace lw {

struct ShellSettings {
    bool on = false;
    int shells = 0;                   ///< --shells: 2 to 4, or 0 for auto
    int samples_per_axis = 2;         ///< --shell-samples, of outer shells at most; the nearest has the source's
    double density = 1.5;             ///< --shell-density: tile pixels per display pixel at the centre, of outer shells
    int tiles_per_side = 4;           ///< of a cube face
    std::optional<double> budget_ms;  ///< --app-budget; nothing: what one main view with guard band costs
    double max_age_s = 4.0;           ///< --max-age
    PriorityWeights weights;
    bool hole_feedback = true;
    const Clock* clock = nullptr;  ///< measures costs; null: they are modelled (replay). Outlives the client
};

}  // namespace lw
