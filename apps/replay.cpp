/// `latewarp replay`: a head trace on the virtual clock, compared with the truth frame by frame.

#include <algorithm>
#include <cstdio>

#include "apps/picture_strip.h"
#include "apps/progress.h"
#include "apps/replay_report.h"
#include "apps/replay_run.h"
#include "apps/report.h"
#include "apps/shell_report.h"
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

/// The pictures of a refresh, two eyes' as the options want them.
class ReplayPictures {
public:
    ReplayPictures(const Options& options, const ReplayRun& run) : options_{options}, run_{run} {}

    /// One picture: the only eye's, or both eyes' side by side, one below the other, or as anaglyph.
    [[nodiscard]] ColourImage packed(std::size_t method) const {
        return packed_of([method](const RefreshPictures& eye) -> const ColourImage& { return eye.shown[method]; });
    }
    [[nodiscard]] ColourImage packed_truth() const {
        return packed_of([](const RefreshPictures& eye) -> const ColourImage& { return eye.truth; });
    }

    [[nodiscard]] Status save(const std::filesystem::path& folder, std::uint64_t refresh) const {
        const std::vector<std::string>& labels = run_.labels();
        const std::string prefix = fmt::format("{:05}.", refresh);
        if (run_.eye_count() == 1 || options_.stereo.layout != EyeLayout::files) {
            Status written = write_png(folder / (prefix + "truth.png"), packed_truth());
            for (std::size_t i = 0; written && i < labels.size(); ++i) {
                written = write_png(folder / (prefix + file_label(labels[i]) + ".png"), packed(i));
            }
            return written;
        }
        Status written{Done{}};
        for (const Eye eye : kEyes) {
            const RefreshPictures& pictures = run_.pictures(static_cast<std::size_t>(eye));
            const std::string end = fmt::format(".{}.png", name_of(eye));
            if (written) written = write_png(folder / (prefix + "truth" + end), pictures.truth);
            for (std::size_t i = 0; written && i < labels.size(); ++i) {
                written = write_png(folder / (prefix + file_label(labels[i]) + end), pictures.shown[i]);
            }
        }
        return written;
    }

private:
    template <class PictureOf>
    [[nodiscard]] ColourImage packed_of(PictureOf picture_of) const {
        if (run_.eye_count() == 1) return picture_of(run_.pictures(0));
        ColourImage both;
        pack_eyes(options_.stereo.layout, picture_of(run_.pictures(0)), picture_of(run_.pictures(1)), both);
        return both;
    }

    const Options& options_;
    const ReplayRun& run_;
};

/// Two eyes' figures: their mean.
std::vector<std::string> strip_lines(const std::string& label, const RefreshRecord& record, std::size_t method) {
    double flip = 0.0;
    std::string psnr;
    for (const EyeRecord& eye : record.eyes) {
        const ImageErrors& errors = eye.errors[method];
        flip += errors.flip / static_cast<double>(record.eyes.size());
        psnr += (psnr.empty() ? "" : ", ") + (errors.psnr_db ? fmt::format("{:.1f} dB", *errors.psnr_db) : "equal");
    }
    return {label, fmt::format("FLIP {:.3f}", flip), "PSNR " + psnr};
}

/// Baselines, the method, the truth: from worst to best, as the README shows them.
ColourImage strip_of(const ReplayRun& run, const ReplayPictures& pictures, const RefreshRecord& record) {
    const std::size_t count = run.labels().size();
    std::vector<ColourImage> shown;
    for (std::size_t i = 0; i < count; ++i) shown.push_back(pictures.packed(i));
    const ColourImage truth = pictures.packed_truth();
    std::vector<StripPicture> entries;
    for (std::size_t i = 1; i <= count; ++i) {
        const std::size_t method = i % count;
        entries.push_back({&shown[method], strip_lines(run.labels()[method], record, method)});
    }
    entries.push_back({&truth, {"truth", "FLIP 0.000"}});
    return picture_strip(entries);
}

std::string description_of(const Options& options, const ReplayResult& result) {
    return fmt::format(
        "Scene {}, trace {} from {} s, {} display frames of {}x{} pixels at {} Hz, client at {} Hz, fill {}, truth "
        "with "
        "{}x{} samples per pixel, FLIP at {:.1f} pixels per degree.{}",
        options.scene, options.trace, options.trace_start_s, result.refreshes.size(), options.size_px.x,
        options.size_px.y, options.display_hz, options.app_hz.value_or(0.0), options.fill, options.truth_samples,
        options.truth_samples, result.pixels_per_degree,
        options.stereo.on
            ? fmt::format(" Two eyes, {} mm apart, {}.", options.stereo.ipd_m * 1e3, name_of(options.stereo.mode))
            : "");
}

std::string mean_of(const std::optional<Distribution>& distribution) {
    return distribution ? fmt::format("{:.4f}", distribution->mean) : "-";
}

void print_stereo_summary(const ReplayResult& result) {
    std::fprintf(stderr, "%-20s %8s %12s %14s %10s\n", "both eyes", "rivalry", "vertical px", "colour excess",
                 "SSIM same");
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        const StereoSummary eyes = stereo_summary_of(result, i);
        std::fprintf(stderr, "%-20s %8s %12s %14s %10s\n", result.labels[i].c_str(),
                     mean_of(eyes.rivalry_fraction).c_str(), mean_of(eyes.vertical_disparity_px).c_str(),
                     mean_of(eyes.colour_excess).c_str(), mean_of(summary_of(result, i).ssim_to_same).c_str());
    }
}

void print_summary(const ReplayResult& result) {
    std::fprintf(stderr, "%-20s %8s %9s %8s %8s\n", "method", "FLIP", "PSNR dB", "SSIM", "holes");
    for (std::size_t i = 0; i < result.labels.size(); ++i) {
        const ErrorSummary summary = summary_of(result, i);
        const std::string psnr_db = summary.psnr_db ? fmt::format("{:.2f}", summary.psnr_db->mean) : "equal";
        std::fprintf(stderr, "%-20s %8.4f %9s %8.4f %8.4f\n", result.labels[i].c_str(), summary.flip->mean,
                     psnr_db.c_str(), summary.ssim->mean, summary.hole_fraction->mean);
    }
    if (result.refreshes.front().eyes.size() == 2) print_stereo_summary(result);
}

Result<ReplayResult> run_all(const Options& options, ReplayRun& run) {
    ReplayResult result;
    result.labels = run.labels();
    result.pixels_per_degree = run.pixels_per_degree();
    Progress progress{"replay", run.refresh_count(), options.quiet};
    for (std::uint64_t i = 0; i < run.refresh_count(); ++i) {
        const std::uint64_t refresh = run.first_refresh() + i;
        run.draw(refresh);
        if (options.save_frames) {
            const Status saved = ReplayPictures{options, run}.save(options.out / "frames", refresh);
            if (!saved) return saved.error();
        }
        result.refreshes.push_back(run.judge());
        progress.show(i + 1);
    }
    result.costs = run.costs();
    result.client_draws = run.client_draws();
    if (run.shells() != nullptr) result.shells = run.shells()->records();
    result.bad_depth_pixels = run.bad_depth_count();
    result.source_pixels_ratio = run.source_pixels_ratio();
    return result;
}

/// The strip is drawn anew when the run is over, since only then it is known which frame is typical.
Status write_strip(const Options& options, ReplayRun& run, const ReplayResult& result,
                   const std::filesystem::path& path) {
    const RefreshRecord& record = result.refreshes[typical_refresh(result)];
    run.draw(record.refresh);
    return write_png(path, strip_of(run, ReplayPictures{options, run}, record));
}

Status write_folder(const Options& options, ReplayRun& run, const ReplayResult& result, const Report& report) {
    const std::filesystem::path strip_path = options.out / "strip.png";
    const Status strip = write_strip(options, run, result, strip_path);
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
    if (!result.shells.empty()) {
        const Status rows = write_text(options.out / "shells.csv", shell_timeline_csv(result.shells));
        const Status plot = write_text(options.out / "shells.svg", shell_timeline_svg(result.shells));
        for (const Status& status : {rows, plot}) {
            if (!status) return status;
        }
    }
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
