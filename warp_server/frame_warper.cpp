#include "warp_server/frame_warper.h"

#include <algorithm>
#include <string>

#include "core/camera_check.h"
#include "core/check.h"
#include "core/placement_check.h"
#include "warp_server/hole_attribution.h"
#include "warp_server/methods/registry.h"

namespace lw {
namespace {

// Before there was any picture.
void show_nothing(glm::ivec2 size_px, DisplayFrame& frame) {
    frame.resize(size_px);
    std::fill(frame.colour.pixels().begin(), frame.colour.pixels().end(), Rgba8{0, 0, 0, 255});
    std::fill(frame.depth.pixels().begin(), frame.depth.pixels().end(), 0.0F);
    std::fill(frame.coverage.pixels().begin(), frame.coverage.pixels().end(), Coverage::filled);
}

}  // namespace

Result<FrameWarper> FrameWarper::create(std::string_view method, std::string_view fill) {
    Result<std::unique_ptr<WarpMethod>> made_method = make_warp_method(method);
    if (!made_method) return made_method.error();
    Result<std::unique_ptr<Fill>> made_fill = make_fill(fill);
    if (!made_fill) return made_fill.error();
    return FrameWarper{std::move(*made_method), std::move(*made_fill)};
}

void FrameWarper::prepare(Layer& layer) const {
    std::shared_ptr<const PreparedLayer> prepared = method_->prepare(layer);
    if (prepared == nullptr) return;
    for (auto& [label, existing] : layer.prepared) {
        if (label != method_->label()) continue;
        existing = std::move(prepared);
        return;
    }
    layer.prepared.emplace_back(std::string{method_->label()}, std::move(prepared));
}

const DisplayFrame& FrameWarper::warp(const RenderedFrame& frame, const WarpTarget& target) {
    if (!begin(frame, target)) return display_frame_;
    if (!usable_layers_.empty()) counters_ = composition_.show(*method_, usable_layers_, usable_, display_frame_);
    finish();
    return display_frame_;
}

void FrameWarper::begin_steps(const RenderedFrame& frame, const WarpTarget& target, int bands) {
    LW_CHECK(can_step(), std::string{method_->label()} + " has no steps");
    is_stepping_ = begin(frame, target) && !usable_layers_.empty();
    if (is_stepping_) composition_.begin_steps(*method_, usable_layers_, usable_, bands, display_frame_);
}

bool FrameWarper::next_stage() {
    if (!is_stepping_) return false;
    is_stepping_ = composition_.next_stage();
    if (!is_stepping_) counters_ = composition_.step_counters();
    return is_stepping_;
}

void FrameWarper::finish_steps() {
    if (!is_reused_) finish();
}

// False: it is the picture that was made last, and nothing is to be done.
bool FrameWarper::begin(const RenderedFrame& frame, const WarpTarget& target) {
    LW_CHECK(!frame.layers.empty(), "a rendered frame has at least one layer");
    held_ = {};
    frame_ = &frame;
    usable_ = usable_target(frame, target);
    is_reused_ = is_made_of(frame, usable_);
    if (is_reused_) {
        held_.bad_layer = made_.bad_layers;
        counters_.pictures_reused = 1;
        return false;
    }
    counters_ = {};
    usable_layers_.clear();
    for (const auto& layer : frame.layers) {
        if (target.eye && layer->for_eye && *layer->for_eye != *target.eye) continue;
        if (!problem_of(layer->camera).empty()) {
            ++held_.bad_layer;
            continue;
        }
        usable_layers_.push_back(layer.get());
    }
    return true;
}

void FrameWarper::finish() {
    if (!usable_layers_.empty()) {
        part_cover_->open(display_frame_);
        fill_->apply(display_frame_, fill_guide(usable_layers_.front()->camera, usable_.camera));
        part_cover_->close(display_frame_);
    } else if (display_frame_.colour.size_px() != usable_.camera.size_px) {
        show_nothing(usable_.camera.size_px, display_frame_);
    }
    remember();
}

void FrameWarper::report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const {
    attribute_holes(display_frame_, frame, head, feedback);
}

bool FrameWarper::is_made_of(const RenderedFrame& frame, const WarpTarget& target) const {
    const auto same_layer = [](const std::weak_ptr<const Layer>& made, const std::shared_ptr<const Layer>& layer) {
        return !made.owner_before(layer) && !layer.owner_before(made);
    };
    return std::equal(made_.layers.begin(), made_.layers.end(), frame.layers.begin(), frame.layers.end(), same_layer) &&
           made_.camera == target.camera && made_.eye == target.eye &&
           std::equal(made_.movers.begin(), made_.movers.end(), target.movers.begin(), target.movers.end());
}

void FrameWarper::remember() {
    made_.layers.assign(frame_->layers.begin(), frame_->layers.end());
    made_.camera = usable_.camera;
    made_.eye = usable_.eye;
    made_.movers.assign(usable_.movers.begin(), usable_.movers.end());
    made_.bad_layers = held_.bad_layer;
}

WarpTarget FrameWarper::usable_target(const RenderedFrame& frame, const WarpTarget& target) {
    WarpTarget usable = target;
    Pose& pose = usable.camera.world_from_eye;
    if (const std::optional<Pose> given = sanitised(pose)) {
        pose = *given;
        good_head_ = pose;
    } else {
        ++held_.bad_head_pose;
        const Pose& drawn = frame.layers.front()->camera.world_from_eye;
        pose = good_head_.value_or(sanitised(drawn).value_or(Pose{}));
    }
    const std::string_view problem = problem_of(usable.camera);
    LW_CHECK(problem.empty(), "a display that cannot be: " + std::string{problem});
    hold_placements(target.movers);
    usable.movers = usable_movers_;
    return usable;
}

// Both lists are by ascending id, as feeds give them; what is out of order is looked for in vain and not held.
void FrameWarper::hold_placements(std::span<const ObjectTransform> movers) {
    usable_movers_.clear();
    std::size_t held = 0;
    for (const ObjectTransform& mover : movers) {
        while (held < good_movers_.size() && good_movers_[held].id < mover.id) ++held;
        const bool known = held < good_movers_.size() && good_movers_[held].id == mover.id;
        if (is_placement(mover.world_from_object)) {
            usable_movers_.push_back(mover);
            continue;
        }
        ++held_.bad_placement;
        if (known) usable_movers_.push_back(good_movers_[held]);
    }
    good_movers_ = usable_movers_;
}

}  // namespace lw
