#pragma once
/// The suites of `latewarp bench`. To add one: a file apps/bench_ID.cpp with `Result<BenchOutput> bench_ID(const
/// Options&)`, and a line in the list at the top of bench_suites.cpp. The command line and the help find it there;
/// `run_bench` (bench.cpp) writes what it returns.

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/html_report.h"
#include "apps/options.h"
#include "apps/report.h"
#include "apps/svg_plot.h"
#include "core/result.h"

namespace lw {

/// What a suite found. A suite fills in its own keys; `run_bench` adds `suite`, `quick` and `wall_s`.
struct BenchOutput {
    Report report{Subcommand::bench};  ///< schema latewarp.bench/1; describe_machine() is the suite's to call
    std::string csv;                   ///< with a header row
    HtmlReport page{""};               ///< self-contained
    /// Written as SVG files NAME.svg beside the page, which may show them too.
    std::vector<std::pair<std::string, SvgPlot>> plots;
    std::string summary;  ///< a few lines for standard error, each ended
    /// File that the JSON report goes to besides, its folder made if missing; empty: none. That it cannot be written is
    /// a warning.
    std::filesystem::path kept_at;
};

struct BenchSuite {
    std::string_view name;
    std::string_view summary;  ///< a few words for --help
    /// Reads quick, data, threads, seed and quiet of the options; prints nothing but progress and warnings.
    Result<BenchOutput> (*run)(const Options& options);
};

/// In the order of the list.
[[nodiscard]] std::span<const BenchSuite> bench_suites();

}  // namespace lw
