/// `latewarp warp`: a frame folder warped to a pose.

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/report.h"
#include "apps/scene_stage.h"
#include "apps/subcommands.h"
#include "core/image_io.h"
#include "frame_link/frame_folder.h"
#include "gl/context.h"
#include "warp_server/frame_warper.h"
#include "warp_server/methods/registry.h"

namespace lw {

namespace {

/// The layer whose camera the target takes what the user left open from.
const Layer& main_layer(const RenderedFrame& frame) {
    const auto main =
        std::find_if(frame.layers.begin(), frame.layers.end(), [](const auto& layer) { return layer->name == "main"; });
    return main != frame.layers.end() ? **main : *frame.layers.front();
}

Camera target_camera(const Options& options, const Camera& source) {
    const Camera given = options.camera();
    Camera target = source;
    if (options.size_given) target.size_px = given.size_px;
    if (options.near_given) target.near_m = given.near_m;
    if (options.fov_given || options.size_given) {
        // A size of another shape keeps the vertical field of view and widens or narrows the horizontal one.
        const double aspect = static_cast<double>(target.size_px.x) / target.size_px.y;
        const double vertical_rad = std::atan(source.fov.up) - std::atan(source.fov.down);
        const bool same_shape = target.size_px.x * source.size_px.y == target.size_px.y * source.size_px.x;
        if (options.fov_given) {
            target.fov = FovTangents::symmetric(options.fov_deg * kRadPerDeg, aspect);
        } else if (!same_shape) {
            target.fov = FovTangents::symmetric(vertical_rad, aspect);
        }
    }
    if (options.pose) target.world_from_eye = *options.pose;
    return target;
}

}  // namespace

Status run_warp(const Options& options) {
    const Status writable = check_output_file(options.output);
    if (!writable) return writable;
    Result<LoadedFrame> loaded = load_frame_folder(options.input);
    if (!loaded) return loaded.error();
    print_warnings(loaded->warnings, options.quiet);
    const Layer& main = main_layer(*loaded->frame);

    std::vector<ObjectTransform> movers = main.movers;
    if (!options.objects.empty()) {
        Result<std::vector<ObjectTransform>> given = load_object_transforms(options.objects);
        if (!given) return given.error();
        movers = *std::move(given);
    }
    std::unique_ptr<gl::Context> context;
    if (find_warp_method(options.method)->needs_gl) {
        Result<std::unique_ptr<gl::Context>> created = gl::Context::create();
        if (!created) return created.error();
        context = *std::move(created);
        context->make_current();
    }
    Result<FrameWarper> warper = FrameWarper::create(options.method, options.fill);
    if (!warper) return warper.error();
    const DisplayFrame& shown = warper->warp(*loaded->frame, {target_camera(options, main.camera), movers});
    return write_png(options.output, shown.colour);
}

}  // namespace lw
