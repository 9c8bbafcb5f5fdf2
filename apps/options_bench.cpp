#include "apps/bench_suites.h"
#include "apps/option_declarer.h"
#include "apps/option_groups.h"

namespace lw {

void declare_bench_run(Declarer& declare) {
    Options& options = declare.options();
    std::string suites;
    for (const BenchSuite& suite : bench_suites()) {
        suites += fmt::format("{}{}: {}", suites.empty() ? "" : "; ", suite.name, suite.summary);
    }
    declare.value("--suite", "SUITE", fmt::format("what is measured ({}); {}", options.bench_suite, suites),
                  [&options](const std::string& text) {
                      std::vector<std::string_view> known;
                      for (const BenchSuite& suite : bench_suites()) known.push_back(suite.name);
                      option_values::check_name("suite", "--suite", text, known);
                      options.bench_suite = text;
                  });
    declare.value("--case", "SEED", "suite stability: this case alone; with --out its frame too",
                  [&options](const std::string& text) {
                      constexpr option_values::Range kSeeds{0, 9e15, true};
                      options.parameters["case"] = option_values::number_in("--case", text, kSeeds);
                  });
    declare.app().add_flag("--quick", options.quick, "a small part of it, at most three minutes");
    declare.path("--data", "DIR", options.data, "folder with gltf/ and head_traces/ (../shared/data)");
    declare.value("--part", "all|errors|times",
                  "suite warp: only errors, or only times, which want a quiet machine (all)",
                  [&options](const std::string& text) {
                      option_values::check_name("part", "--part", text, {"all", "errors", "times"});
                      options.bench_part = text;
                  });
    declare.path("--merge", "FILE.json", options.bench_merge,
                 "with --part: an earlier report, for the other part and the times it has");
    declare.number("--at-most", "S", {0, 1e9}, options.bench_most_s,
                   "begin no time after so many seconds; --part times --merge goes on");
}

void declare_autotune(Declarer& declare) {
    Options& options = declare.options();
    declare.number("--error-cap", "FLIP", {1e-6, 1}, options.error_cap,
                   "--method auto: the cheapest method with at most this error");
    declare.number("--budget-ms", "MS", {1e-3, 1e5}, options.budget_ms,
                   "--method auto: the most exact method that takes at most so long");
    declare.path("--bench-data", "FILE.json", options.bench_data,
                 "--method auto: report of latewarp bench (the last one of this machine)");
}

}  // namespace lw
