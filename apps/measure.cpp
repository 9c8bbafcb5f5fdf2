/// `latewarp measure`: a live run without a window, for its numbers.

#include <cstdio>

#include "apps/latency_page.h"
#include "apps/live_report.h"
#include "apps/live_timeline.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"

namespace lw {

namespace {

/// The span of the time line: two frames of a client at 10 Hz.
constexpr Duration kTimelineSpan = std::chrono::milliseconds{250};

Status write_measurement(const Options& options, const LiveResult& result) {
    const LatencyHarness harness = latency_of(result);
    if (const Status csv = write_text(options.out / "refreshes.csv", refreshes_csv(result, harness)); !csv) return csv;
    const std::string timeline = svg_of(timeline_of(result, kTimelineSpan), SvgUse::standalone);
    if (const Status svg = write_text(options.out / "timeline.svg", timeline); !svg) return svg;
    return write_text(options.out / "report.html", latency_page(options, result, harness));
}

}  // namespace

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
        const Status written = write_measurement(options, *result);
        if (!written) return written;
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
