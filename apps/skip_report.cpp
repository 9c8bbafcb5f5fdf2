#include "apps/skip_report.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.h"

namespace lw {

void describe_skipped(Report& report, std::span<const DrawCounters> frames) {
    static constexpr std::array<std::pair<const char*, std::uint64_t DrawCounters::*>, 15> kCounters{{
        {"objects_tested", &DrawCounters::objects_tested},
        {"objects_outside", &DrawCounters::objects_outside},
        {"objects_behind_walls", &DrawCounters::objects_behind_walls},
        {"objects_occluded", &DrawCounters::objects_occluded},
        {"objects_too_small", &DrawCounters::objects_too_small},
        {"objects_between_samples", &DrawCounters::objects_between_samples},
        {"objects_drawn", &DrawCounters::objects_drawn},
        {"clusters_tested", &DrawCounters::clusters_tested},
        {"clusters_outside", &DrawCounters::clusters_outside},
        {"clusters_turned_away", &DrawCounters::clusters_turned_away},
        {"clusters_occluded", &DrawCounters::clusters_occluded},
        {"clusters_too_small", &DrawCounters::clusters_too_small},
        {"clusters_between_samples", &DrawCounters::clusters_between_samples},
        {"triangles_drawn", &DrawCounters::triangles_drawn},
        {"draw_calls", &DrawCounters::draw_calls},
    }};
    for (const auto& [name, counter] : kCounters) {
        std::vector<double> values;
        values.reserve(frames.size());
        for (const DrawCounters& frame : frames) values.push_back(static_cast<double>(frame.*counter));
        const auto distribution = distribution_of(values);
        if (distribution) report.set(std::string{"skip/"} + name, distribution->p50);
    }
}

}  // namespace lw
