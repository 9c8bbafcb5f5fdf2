#pragma once
/// The suite `billboards` as JSON, CSV, plots and a page.

#include "apps/bench_suites.h"
#include "apps/billboard_bench_runs.h"

namespace lw {

[[nodiscard]] BenchOutput output_of(const BillboardBench& bench, const scene::Scene& scene);

}  // namespace lw
