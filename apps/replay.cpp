/// `latewarp replay`: a head trace on the virtual clock, compared with the truth frame by frame.

#include <algorithm>
#include <cstdio>

#include "apps/picture_strip.h"
#include "apps/progress.h"
#include "apps/replay_report.h"
#include "apps/replay_run.h"
#include "apps/report.h"
#include "apps/subcommands.h"
#include "core/image_io.h"

namespace lw {

namespace {

/// "points:size_px=2" as part of a file name.
std::string file_label(std::string label) {
    for (char& c : label) {
        if (c == ':' || c == '=' || c == ',' || c == '/') c = '-';
    }
    return label;
}

Status save_pictures(const std::filesystem::path& folder, std::uint64_t refresh, const std::vector<std::string>& labels,
                     const RefreshPictures& pictures) {
    const auto path = [&](const std::string& label) {
        return folder / fmt::format("{:05}.{}.png", refresh, file_label(label));
    };
    Status written = write_png(path("truth"), pictures.truth);
    for (std::size_t i = 0; written && i < labels.size(); ++i) written = write_png(path(labels[i]), pictures.shown[i]);
    return written;
}

/// Baselines, the method, the truth: from worst to best, as the README shows them.
ColourImage strip_of(const std::vector<std::string>& labels, const RefreshPictures& pictures,
                     const RefreshRecord& record) {
    std::vector<StripPicture> entries;
    const auto add = [&](std::size_t i) {
        const ImageErrors& errors = record.errors[i];
        const std::string psnr = errors.psnr_db ? fmt::format("PSNR {:.1f} dB", *errors.psnr_db) : "equal";
        entries.push_back({&pictures.shown[i], {labels[i], fmt::format("FLIP {:.3f}", errors.flip), psnr}});
    };
    for (std::size_t i = 1; i < labels.size(); ++i) add(i);
    add(0);
    entries.push_back({&pictures.truth, {"truth", "FLIP 0.000"}});
    return picture_strip(entries);
}

std::string description_of(const Options& options, const ReplayResult& result) {
    return fmt::format(
        "Scene {}, trace {} from {} s, {} display frames of {}x{} pixels at {} Hz, client at {} Hz, fill {}, truth "
        "with "
        "{}x{} samples per pixel, FLIP at {:.1f} pixels per degree.",
        options.scene, options.trace, options.trace_start_s, result.refreshes.size(), options.size_px.x,
        options.size_px.y, options.display_hz, options.app_hz.value_or(0.0), options.fill, options.truth_samples,
        options.truth_samples, result.pixels_per_degree);
}

void print_summary(const ReplayResult& result) {
    std::fprintf(stderr, "%-20s %8s %9s %8s %8s\n", "method", "FLIP", "PSNR dB", "SSIM", "holes");
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        const ErrorSummary summary = summary_of(result, i);
        const std::string psnr_db = summary.psnr_db ? fmt::format("{:.2f}", summary.psnr_db->mean) : "equal";
        std::fprintf(stderr, "%-20s %8.4f %9s %8.4f %8.4f\n", result.labels[i].c_str(), summary.flip->mean,
                     psnr_db.c_str(), summary.ssim->mean, summary.hole_fraction->mean);
    }
}

Result<ReplayResult> run_all(const Options& options, ReplayRun& run) {
    ReplayResult result;
    result.labels = run.labels();
    result.pixels_per_degree = run.pixels_per_degree();
    Progress progress{"replay", run.refresh_count(), options.quiet};
    for (std::uint64_t i = 0; i < run.refresh_count(); ++i) {
        const std::uint64_t refresh = run.first_refresh() + i;
        const RefreshPictures& pictures = run.draw(refresh);
        if (options.save_frames) {
            const Status saved = save_pictures(options.out / "frames", refresh, result.labels, pictures);
            if (!saved) return saved.error();
        }
        result.refreshes.push_back(run.judge());
        progress.show(i + 1);
    }
    result.costs = run.costs();
    result.client_draws = run.client_draws();
    result.bad_depth_pixels = run.bad_depth_count();
    result.source_pixels_ratio = run.source_pixels_ratio();
    return result;
}

/// The strip is drawn anew when the run is over, since only then it is known which frame is typical.
Status write_strip(ReplayRun& run, const ReplayResult& result, const std::filesystem::path& path) {
    const RefreshRecord& record = result.refreshes[typical_refresh(result)];
    const RefreshPictures& pictures = run.draw(record.refresh);
    return write_png(path, strip_of(result.labels, pictures, record));
}

Status write_folder(const Options& options, ReplayRun& run, const ReplayResult& result, const Report& report) {
    const std::filesystem::path strip_path = options.out / "strip.png";
    const Status strip = write_strip(run, result, strip_path);
    if (!strip) return strip;
    const auto strip_png = read_file(strip_path);
    if (!strip_png) return strip_png.error();
    const Status csv = write_text(options.out / "frames.csv", replay_csv(result));
    if (!csv) return csv;
    const std::string title =
        fmt::format("Latewarp replay: {} along {}", std::filesystem::path{options.scene}.filename().string(),
                    std::filesystem::path{options.trace}.filename().string());
    const Status html = write_text(options.out / "report.html",
                                   replay_html(result, title, description_of(options, result), *strip_png));
    if (!html) return html;
    return report.write(options.out / "report.json");
}

/// Settings that replay fills in, so that the report names them.
Options with_replay_defaults(Options options) {
    if (!options.app_hz) options.app_hz = 10.0;
    if (!options.app_latency_ms) options.app_latency_ms = 1000.0 / *options.app_hz;
    if (!options.predict) options.predict = "oracle";
    return options;
}

Status make_folders(const Options& options) {
    if (!options.report.empty()) {
        const Status status = check_output_file(options.report);
        if (!status) return status;
    }
    if (options.out.empty()) return Done{};
    const Status out = make_output_folder(options.out);
    return out && options.save_frames ? make_output_folder(options.out / "frames") : out;
}

}  // namespace

Status run_replay(const Options& given) {
    const Options options = with_replay_defaults(given);
    const Status folders = make_folders(options);
    if (!folders) return folders;
    Result<Trace> trace = load_trace(options.trace);
    if (!trace) return trace.error();
    print_warnings(trace->warnings(), options.quiet);
    Result<SceneStage> stage = make_stage(options);
    if (!stage) return stage.error();
    Result<ReplayRun> run = ReplayRun::create(options, *trace, *stage);
    if (!run) return run.error();

    Result<ReplayResult> result = run_all(options, *run);
    if (!result) return result.error();
    Report report{Subcommand::replay};
    describe_machine(report, stage->context.get());
    describe_scene(report, *stage->scene);
    describe_settings(report, options);
    add_replay_results(report, *result);
    if (!options.quiet) print_summary(*result);
    if (!options.report.empty()) {
        const Status written = report.write(options.report);
        if (!written) return written;
    }
    if (!options.out.empty()) return write_folder(options, *run, *result, report);
    if (options.report.empty()) std::fputs(report.text().c_str(), stdout);
    return Done{};
}

}  // namespace lw
