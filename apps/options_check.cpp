// What of all options does not go together.

#include <algorithm>

#include "apps/option_declarer.h"
#include "apps/option_groups.h"
#include "apps/option_values.h"
#include "apps/stereo_options.h"
#include "client_renderer/source_camera.h"

namespace lw {
namespace {

using namespace option_values;

/// The options of --method auto come together or not at all.
Status check_autotune(const Options& options) {
    const int limits = (options.error_cap ? 1 : 0) + (options.budget_ms ? 1 : 0);
    if (options.method == "auto") {
        if (limits == 1) return Done{};
        return Error{limits == 0 ? "nothing to choose by" : "two things to choose by", "--method auto",
                     "add either --error-cap or --budget-ms"};
    }
    if (limits == 0 && options.bench_data.empty()) return Done{};
    return Error{"no method to choose", "--error-cap, --budget-ms and --bench-data", "add --method auto"};
}

/// Of the views that the client draws.
glm::ivec2 largest_source_px(const Options& options) {
    glm::ivec2 largest_px{0};
    const auto views = drawn_views_of(options, nullptr);
    if (!views) return largest_px;
    for (const DrawnView& view : *views) {
        largest_px = glm::max(largest_px, SourceCameras{view.camera, options.source}.largest().size_px);
    }
    return largest_px;
}

}  // namespace

bool is_live(const Options& options) {
    return options.subcommand == Subcommand::demo || options.subcommand == Subcommand::measure;
}

Status check_together(const Options& options) {
    const Status autotune = check_autotune(options);
    if (!autotune) return autotune;
    if (options.shells.on && options.stereo.on && options.stereo.mode != StereoMode::one_render) {
        return Error{"shells are drawn from between the eyes",
                     fmt::format("--shells --stereo {}", name_of(options.stereo.mode)),
                     "choose --stereo one-render, or leave out --shells"};
    }
    if (options.shells.on && options.billboards.mode != BillboardMode::off) {
        return Error{"shells draw far objects as they are", "--shells --billboards", "leave out one of them"};
    }
    if (options.strips.value_or(1) > options.size_px.y) {
        return Error{"more strips than rows", fmt::format("--strips {}", *options.strips),
                     fmt::format("choose at most {} for this --size", options.size_px.y)};
    }
    const Status stereo = check_stereo(options);
    if (!stereo) return stereo;
    if (!options.bench_merge.empty() && options.bench_part == "all") {
        return Error{"nothing to merge", "--merge", "add --part errors or --part times"};
    }
    const bool draws = options.subcommand == Subcommand::replay || options.subcommand == Subcommand::render;
    const int longest_px = std::max(options.size_px.x, options.size_px.y) * options.truth_samples;
    if (draws && longest_px > 2 * kMaxSidePx) {
        return Error{
            "too many samples for this size",
            fmt::format("--size {}x{} --truth-samples {}", options.size_px.x, options.size_px.y, options.truth_samples),
            fmt::format("keep the longer side times the samples below {}", 2 * kMaxSidePx)};
    }
    const glm::ivec2 source_px = largest_source_px(options);
    if ((draws || is_live(options)) && std::max(source_px.x, source_px.y) > 2 * kMaxSidePx) {
        return Error{"too large a frame of the client", fmt::format("{}x{} pixels", source_px.x, source_px.y),
                     "choose a smaller --size, --source-density or --guard-band"};
    }
    if (options.save_frames && options.out.empty() && options.subcommand == Subcommand::replay) {
        return Error{"no folder for the images", "--save-frames", "add --out DIR"};
    }
    return Done{};
}

}  // namespace lw
