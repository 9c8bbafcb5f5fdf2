#include "apps/live_warper.h"

#include <utility>

#include "apps/scene_stage.h"
#include "warp_server/methods/registry.h"

namespace lw {
namespace {

// Its method and what it shows in holes follow the keys.
Result<FrameWarper> make_demo_warper(const Options& options, const DemoControls& keys, LiveWarper& made) {
    auto method = make_demo_method(options.method, keys);
    if (!method) return method.error();
    auto fill = make_fill(options.fill);
    if (!fill) return fill.error();
    made.demo_method = method->get();
    return FrameWarper{std::move(*method), make_demo_fill(std::move(*fill), keys)};
}

Result<LiveWarper> make_mono(const Options& options, const DemoControls* keys) {
    LiveWarper made;
    auto warper =
        keys == nullptr ? FrameWarper::create(options.method, options.fill) : make_demo_warper(options, *keys, made);
    if (!warper) return warper.error();
    auto one_eye = std::make_unique<FrameWarper>(*std::move(warper));
    made.one_eye = one_eye.get();
    made.maker = std::move(one_eye);
    return made;
}

Result<LiveWarper> make_stereo(const Options& options, const StereoSettings& settings, const DemoControls* keys) {
    LiveWarper made;
    std::unique_ptr<StereoWarper> two_eyes;
    if (keys == nullptr) {
        auto warper =
            StereoWarper::create(options.method, options.fill, options.stereo.mode, options.camera(), settings);
        if (!warper) return warper.error();
        two_eyes = std::move(*warper);
    } else {
        auto left = make_demo_warper(options, *keys, made);
        if (!left) return left.error();
        auto right = make_demo_warper(options, *keys, made);
        if (!right) return right.error();
        two_eyes = std::make_unique<StereoWarper>(*std::move(left), *std::move(right), settings);
    }
    made.two_eyes = two_eyes.get();
    made.maker = std::move(two_eyes);
    return made;
}

}  // namespace

Result<LiveWarper> make_live_warper(const Options& options, const Trace& trace, const DemoControls* keys) {
    const bool needs_gl = find_warp_method(options.method)->needs_gl;
    if (needs_gl) keys = nullptr;  // the others are CPU methods
    if (!options.stereo.on) return make_mono(options, keys);
    if (options.stereo.mode == StereoMode::scanline) keys = nullptr;
    return make_stereo(options, {stereo_rig_of(options, &trace), options.stereo.layout, !needs_gl}, keys);
}

}  // namespace lw
