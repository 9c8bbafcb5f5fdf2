#pragma once
/// Summary of a set of numbers, as every report writes it.

#include <optional>
#include <span>

namespace lw {

/// Percentiles are by nearest rank: p95 is the smallest sample that at least 95 % of the samples do not exceed. So
/// every number but the mean is one that occurred.
struct Distribution {
    double mean = 0.0;
    double min = 0.0;
    double p5 = 0.0;
    double p50 = 0.0;
    double p95 = 0.0;
    double p99 = 0.0;
    double max = 0.0;

    friend bool operator==(const Distribution&, const Distribution&) = default;
};

/// Nothing without samples. A sample that is not finite is a programmer error: leave it out and count it. Pure, any
/// thread.
[[nodiscard]] std::optional<Distribution> distribution_of(std::span<const double> samples);

/// Nearest-rank percentile of samples in ascending order, `percent` in (0, 100]; `sorted` is not empty. Pure, any
/// thread.
[[nodiscard]] double percentile_of_sorted(std::span<const double> sorted, double percent);

}  // namespace lw
