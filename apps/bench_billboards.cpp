/// The suite `billboards`: the stress test of a thousand objects along a flight through them.

#include "apps/bench_suites.h"
#include "apps/billboard_bench_report.h"
#include "apps/billboard_bench_runs.h"
#include "gl/context.h"
#include "scene/built_in.h"

namespace lw {

Result<BenchOutput> bench_billboards(const Options& options) {
    scene::Parameters parameters;
    if (options.seed) parameters["seed"] = static_cast<double>(*options.seed);
    const Result<scene::Scene> scene = scene::make_built_in("chairs", parameters);
    if (!scene) return scene.error();
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    (*context)->make_current();
    const Result<BillboardBench> bench = run_billboard_bench(*scene, options);
    if (!bench) return bench.error();
    return output_of(*bench, *scene);
}

}  // namespace lw
