/// `latewarp measure`: a live run without a window, for its numbers.

#include <cstdio>

#include "apps/live_report.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"

namespace lw {

Status run_measure(const Options& given) {
    Options options = given;
    if (options.report.empty() && !options.out.empty()) options.report = options.out / "report.json";
    if (!options.out.empty()) {
        if (const Status folder = make_output_folder(options.out); !folder) return folder;
    }
    if (!options.report.empty()) {
        if (const Status file = check_output_file(options.report); !file) return file;
    }
    const auto scene = load_scene_of(options);
    if (!scene) return scene.error();
    const auto trace = load_trace(options.trace);
    if (!trace) return trace.error();
    print_warnings(trace->warnings(), options.quiet);
    const Trace placed = trace->placed_at(start_pose_of(**scene), options.trace_start_s);

    Report report{Subcommand::measure};
    const auto after = [&](SceneRenderer&, const gl::Context& context, const LiveResult&) -> Status {
        describe_machine(report, &context);
        return Done{};
    };
    const auto result = run_live(options, **scene, placed, false, after);
    if (!result) return result.error();

    describe_scene(report, **scene);
    describe_settings(report, options);
    describe_live_run(report, options, *result);
    if (!options.out.empty()) {
        const Status csv = write_text(options.out / "refreshes.csv", refreshes_csv(*result));
        if (!csv) return csv;
    }
    if (options.report.empty()) {
        std::fputs(report.text().c_str(), stdout);
    } else if (const Status written = report.write(options.report); !written) {
        return written;
    }
    if (!options.quiet) std::fputs(live_summary_text(options, *result).c_str(), stderr);
    return Done{};
}

}  // namespace lw
