/// `latewarp demo`: a slow client and a fast server, live; in a window if there is a display.

#include <cstdio>

#include "apps/live_report.h"
#include "apps/live_strip.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"
#include "apps/window_presenter.h"
#include "core/image_io.h"

namespace lw {
namespace {

Status write_strip(const Options& options, const LiveResult& result, SceneRenderer& renderer) {
    const DisplayRecord* refresh = telling_refresh(result);
    if (refresh == nullptr) {
        return Error{"no picture was shown in time", options.scene, "give it more --seconds or a smaller --size"};
    }
    const auto strip = live_strip(options, result, *refresh, renderer);
    if (!strip) return strip.error();
    return write_png(options.out / "strip.png", *strip);
}

/// What each eye saw last, as --stereo-output wants it.
Status write_eyes(const Options& options, const LiveResult& result) {
    if (result.last_eyes.empty()) return Done{};
    if (options.stereo.layout != EyeLayout::files) {
        ColourImage both;
        pack_eyes(options.stereo.layout, result.last_eyes[0], result.last_eyes[1], both);
        return write_png(options.out / "eyes.png", both);
    }
    Status written{Done{}};
    for (const Eye eye : kEyes) {
        const ColourImage& picture = result.last_eyes[static_cast<std::size_t>(eye)];
        if (written) written = write_png(options.out / fmt::format("eyes.{}.png", name_of(eye)), picture);
    }
    return written;
}

}  // namespace

Status run_demo(const Options& given) {
    Options options = given;
    if (options.out.empty()) options.out = "latewarp-out";
    if (options.report.empty()) options.report = options.out / "report.json";
    if (const Status folder = make_output_folder(options.out); !folder) return folder;
    if (const Status file = check_output_file(options.report); !file) return file;

    const auto scene = load_scene_of(options);
    if (!scene) return scene.error();
    const auto trace = load_trace(options.trace);
    if (!trace) return trace.error();
    print_warnings(trace->warnings(), options.quiet);
    const Trace placed = trace->placed_at(start_pose_of(**scene), options.trace_start_s);

    const bool window = WindowPresenter::is_display_present();
    if (!options.quiet) {
        std::fprintf(stderr, "latewarp demo: %s, %dx%d, %g s, %s\n", (*scene)->name.c_str(), options.size_px.x,
                     options.size_px.y, options.seconds,
                     window ? "in a window, whose lower edge names the keys" : "no display, so without a window");
    }
    Report report{Subcommand::demo};
    const auto after = [&](SceneRenderer& renderer, const gl::Context& context, const LiveResult& result) {
        describe_machine(report, &context);
        return write_strip(options, result, renderer);
    };
    const auto result = run_live(options, **scene, placed, window, after);
    if (!result) return result.error();

    describe_scene(report, **scene);
    describe_settings(report, options);
    describe_live_run(report, options, *result);
    if (const Status csv = write_text(options.out / "refreshes.csv", refreshes_csv(*result)); !csv) return csv;
    if (const Status eyes = write_eyes(options, *result); !eyes) return eyes;
    if (const Status written = report.write(options.report); !written) return written;
    if (!options.quiet) {
        std::fprintf(stderr, "%swrote    %s, %s\n", live_summary_text(options, *result).c_str(), options.report.c_str(),
                     (options.out / "strip.png").c_str());
    }
    return Done{};
}

}  // namespace lw
