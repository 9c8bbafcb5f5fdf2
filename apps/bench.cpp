/// `latewarp bench`: runs one suite and writes what it found.

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "apps/bench_suites.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"

namespace lw {

namespace {

const BenchSuite& suite_of(const Options& options) {
    const auto suites = bench_suites();
    const auto found = std::find_if(suites.begin(), suites.end(),
                                    [&](const BenchSuite& suite) { return suite.name == options.bench_suite; });
    LW_CHECK(found != suites.end(), options.bench_suite);
    return *found;
}

Status check_outputs(const Options& options) {
    if (!options.report.empty()) {
        const Status status = check_output_file(options.report);
        if (!status) return status;
    }
    return options.out.empty() ? Status{Done{}} : make_output_folder(options.out);
}

Status write_folder(const std::filesystem::path& folder, const BenchOutput& output) {
    Status written = output.report.write(folder / "report.json");
    if (written) written = write_text(folder / "report.csv", output.csv);
    if (written) written = write_text(folder / "report.html", output.page.text());
    for (const auto& [name, plot] : output.plots) {
        if (written) written = write_text(folder / (name + ".svg"), svg_of(plot, SvgUse::standalone));
    }
    return written;
}

/// A folder that cannot be written must not lose the run.
void keep_for_later(const BenchOutput& output, bool quiet) {
    if (output.kept_at.empty()) return;
    Status kept = make_output_folder(output.kept_at.parent_path());
    if (kept) kept = output.report.write(output.kept_at);
    if (!kept) print_warnings({kept.error().message()}, quiet);
}

}  // namespace

Status run_bench(const Options& options) {
    const Status outputs = check_outputs(options);
    if (!outputs) return outputs;
    const auto begin = std::chrono::steady_clock::now();
    Result<BenchOutput> output = suite_of(options).run(options);
    if (!output) return output.error();
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    output->report.set("suite", options.bench_suite);
    output->report.set("quick", options.quick);
    output->report.set("wall_s", wall.count());
    keep_for_later(*output, options.quiet);
    if (!options.quiet) std::fputs(output->summary.c_str(), stderr);
    if (!options.report.empty()) {
        const Status written = output->report.write(options.report);
        if (!written) return written;
    }
    if (!options.out.empty()) return write_folder(options.out, *output);
    if (options.report.empty()) std::fputs(output->report.text().c_str(), stdout);
    return Done{};
}

}  // namespace lw
