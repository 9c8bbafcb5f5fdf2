#pragma once
/// Runs the warp suite's plan. Errors and times are measured apart: errors do not depend on what else the machine does,
/// and need many pictures; times need a quiet machine, and few.

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "apps/bench_point.h"
#include "apps/warp_sweep_plan.h"
#include "core/result.h"
#include "gl/context.h"

namespace lw {

/// One point per cell and setting, in the plan's order, without errors and times.
[[nodiscard]] std::vector<BenchPoint> points_of(const SweepPlan& plan);

struct SweepSettings {
    int threads = 0;      ///< for the error figures; 0: all cores
    bool quiet = false;   ///< no progress
    double most_s = 1e9;  ///< times: nothing more is begun after so many seconds
};

/// Fills in the errors of `points` (as points_of() gave them). Each truth, each fresh picture and each source is drawn
/// once and shared by all methods. GL work happens on a context of its own, on the calling thread; error figures on up
/// to `settings.threads` threads. The same plan gives the same errors.
[[nodiscard]] Result<std::vector<FreshErrors>> measure_errors(const SweepPlan& plan, const SweepSettings& settings,
                                                              std::vector<BenchPoint>& points);

/// Fills in the times of those `points` that have none, taken on the plan's first pair: warp and fill together,
/// `repeats` times after a warm-up, in turns with copies of the colour and depth of the same source; sources take turns
/// too, so that nobody finds his in the cache. Times do not depend on the source's samples, so points that differ in
/// them alone share one measurement. Returns what the machine did meanwhile: the median over the points on one thread
/// of processor time per wall time (1 on a quiet machine); nothing if there was no such point.
[[nodiscard]] Result<std::optional<double>> measure_times(const SweepPlan& plan, const SweepSettings& settings,
                                                          int repeats, std::vector<BenchPoint>& points);

}  // namespace lw
