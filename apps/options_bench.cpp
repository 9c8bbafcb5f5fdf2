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
    declare.app().add_flag("--quick", options.quick, "a small part of it, at most three minutes");
    declare.path("--data", "DIR", options.data, "folder with gltf/ and head_traces/ (../shared/data)");
}

}  // namespace lw
