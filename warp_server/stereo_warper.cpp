#include "warp_server/stereo_warper.h"

#include "warp_server/methods/scanline.h"

namespace lw {
namespace {

Result<FrameWarper> scanline_warper(std::string_view fill, const Camera& display, const StereoRig& rig) {
    auto method =
        make_scanline_method(eye_camera(display, rig.eye(Eye::right), {}), eye_camera(display, rig.eye(Eye::left), {}));
    if (!method) return method.error();
    auto made_fill = make_fill(fill);
    if (!made_fill) return made_fill.error();
    return FrameWarper{std::move(*method), std::move(*made_fill)};
}

}  // namespace

StereoWarper::StereoWarper(FrameWarper left, FrameWarper right, const StereoSettings& settings)
    : settings_{settings}, layout_{settings.layout}, warpers_{std::move(left), std::move(right)} {
    if (settings.parallel) pool_ = std::make_unique<TaskPool>(2);
}

StereoWarper::~StereoWarper() = default;

Result<std::unique_ptr<StereoWarper>> StereoWarper::create(std::string_view method, std::string_view fill,
                                                           StereoMode mode, const Camera& display,
                                                           const StereoSettings& settings) {
    const bool by_rows = mode == StereoMode::scanline;
    Result<FrameWarper> left =
        by_rows ? scanline_warper(fill, display, settings.rig) : FrameWarper::create(method, fill);
    if (!left) return left.error();
    Result<FrameWarper> right = FrameWarper::create(by_rows ? "stale" : method, fill);
    if (!right) return right.error();
    return std::make_unique<StereoWarper>(*std::move(left), *std::move(right), settings);
}

// Both warpers are of one method with one label: what one prepared the other finds.
void StereoWarper::prepare(Layer& layer) const { warpers_[0].prepare(layer); }

const DisplayFrame& StereoWarper::warp(const RenderedFrame& frame, const WarpTarget& target) {
    warp_eyes(frame, target);
    pack_eyes(layout_.load(std::memory_order_relaxed), warpers_[0].display_frame().colour,
              warpers_[1].display_frame().colour, packed_.colour);
    return packed_;
}

void StereoWarper::warp_eyes(const RenderedFrame& frame, const WarpTarget& target) {
    frame_ = &frame;
    head_ = &target;
    if (warpers_[0].can_step() && warpers_[1].can_step()) {
        warp_in_turns();
    } else {
        run(2, warp_eye_);
    }
    counters_ = {};
    held_ = {};
    for (const FrameWarper& warper : warpers_) {
        counters_ += warper.counters();
        held_ += warper.held();
    }
}

WarpTarget StereoWarper::target_of(Eye eye) const {
    WarpTarget target = *head_;
    target.camera = eye_camera(head_->camera, settings_.rig.eye(eye), head_->camera.world_from_eye);
    target.eye = eye;
    return target;
}

void StereoWarper::warp_eye(Eye eye) { warpers_[static_cast<std::size_t>(eye)].warp(*frame_, target_of(eye)); }

void StereoWarper::warp_in_turns() {
    const int bands = pool_ ? pool_->threads() : 1;
    for (const Eye eye : kEyes) {
        warpers_[static_cast<std::size_t>(eye)].begin_steps(*frame_, target_of(eye), bands);
    }
    bool more = true;
    while (more) {
        run(bands, step_band_);
        more = false;
        for (FrameWarper& warper : warpers_) more = warper.next_stage() || more;
    }
    run(2, finish_eye_);
}

void StereoWarper::step_band(int band) {
    bool more = true;
    while (more) {
        more = false;
        for (FrameWarper& warper : warpers_) more = warper.step(band) || more;
    }
}

// On the pool's threads, which are two, or one after the other.
void StereoWarper::run(int tasks, const TaskPool::Work& work) {
    if (pool_) {
        pool_->run(tasks, work);
    } else {
        for (int task = 0; task < tasks; ++task) work(task, 0);
    }
}

void StereoWarper::report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const {
    for (const Eye which : kEyes) {
        eye(which).report_holes(frame, eye_camera(head, settings_.rig.eye(which), head.world_from_eye), feedback);
    }
}

}  // namespace lw
