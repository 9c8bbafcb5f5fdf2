#include "core/statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"

namespace lw {

double percentile_of_sorted(std::span<const double> sorted, double percent) {
    LW_CHECK(!sorted.empty() && percent > 0.0 && percent <= 100.0,
             fmt::format("{} percent of {} samples", percent, sorted.size()));
    // The subtrahend keeps a rank that is whole in exact arithmetic (95 % of 20) from being rounded up by a last bit.
    const double rank = std::ceil(percent / 100.0 * static_cast<double>(sorted.size()) - 1e-9);
    const auto index = static_cast<std::size_t>(std::max(rank, 1.0)) - 1;
    return sorted[std::min(index, sorted.size() - 1)];
}

std::optional<Distribution> distribution_of(std::span<const double> samples) {
    if (samples.empty()) return std::nullopt;
    std::vector<double> sorted{samples.begin(), samples.end()};
    double sum = 0.0;
    for (const double sample : sorted) {
        LW_CHECK(std::isfinite(sample), fmt::format("sample {}", sample));
        sum += sample;
    }
    std::sort(sorted.begin(), sorted.end());
    Distribution result;
    // The mean of equal samples must not leave them by a rounding.
    result.mean = std::clamp(sum / static_cast<double>(sorted.size()), sorted.front(), sorted.back());
    result.min = sorted.front();
    result.p5 = percentile_of_sorted(sorted, 5.0);
    result.p50 = percentile_of_sorted(sorted, 50.0);
    result.p95 = percentile_of_sorted(sorted, 95.0);
    result.p99 = percentile_of_sorted(sorted, 99.0);
    result.max = sorted.back();
    return result;
}

}  // namespace lw
