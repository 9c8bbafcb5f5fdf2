#include "apps/bench_suites.h"

namespace lw {

// The list of suites. To add one: a file apps/bench_ID.cpp with `Result<BenchOutput> bench_ID(const Options&)`, and a
// line here:  ID, name, a few words for --help.
#define LW_BENCH_SUITES(SUITE)                                                                                      \
    SUITE(warp, "warp", "run time of every warp method against its error")                                          \
    SUITE(skip, "skip", "what leaving out costs and saves, and that nothing is missed")                             \
    SUITE(stability, "stability", "numerical error of every warp method, of depth formats and far from the origin") \
    SUITE(billboards, "billboards", "a thousand objects as meshes and as billboards")

#define LW_DECLARE(id, ...) Result<BenchOutput> bench_##id(const Options& options);
LW_BENCH_SUITES(LW_DECLARE)
#undef LW_DECLARE

namespace {

#define LW_ENTRY(id, name, summary) {name, summary, bench_##id},
constexpr BenchSuite kSuites[] = {LW_BENCH_SUITES(LW_ENTRY)};
#undef LW_ENTRY

}  // namespace

std::span<const BenchSuite> bench_suites() { return kSuites; }

}  // namespace lw
