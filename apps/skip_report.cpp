#include "apps/skip_report.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/statistics.h"

namespace lw {

void describe_skipped(Report& report, std::span<const DrawCounters> frames) {
    static constexpr std::array<std::pair<const char*, std::uint64_t DrawCounters::*>, 6> kCounters{{
        {"objects_tested", &DrawCounters::objects_tested},
        {"objects_outside", &DrawCounters::objects_outside},
        {"objects_occluded", &DrawCounters::objects_occluded},
        {"objects_drawn", &DrawCounters::objects_drawn},
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
