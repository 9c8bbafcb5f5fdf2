#pragma once
/// What ends every benchmark program.

#include <benchmark/benchmark.h>

namespace lw::bench {

/// Runs what was registered, as the command line asks. The program's exit status.
inline int run_benchmarks(int argc, char** argv) {
    benchmark::Initialize(&argc, argv);
    if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    benchmark::RunSpecifiedBenchmarks();
    benchmark::Shutdown();
    return 0;
}

}  // namespace lw::bench
