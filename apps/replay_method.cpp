#include "apps/replay_method.h"

#include <utility>

namespace lw {

Result<ReplayMethod> ReplayMethod::create(const std::string& label, const Options& options,
                                          const std::optional<StereoRig>& rig) {
    ReplayMethod made;
    made.label_ = label;
    if (rig) made.mode_ = find_stereo_mode(label).value_or(options.stereo.mode);
    if (is_fresh_baseline(label)) return made;
    if (!rig) {
        Result<FrameWarper> warper = FrameWarper::create(label, options.fill);
        if (!warper) return warper.error();
        made.mono_ = *std::move(warper);
        return made;
    }
    const std::string& method = find_stereo_mode(label) ? options.method : label;
    auto warper = StereoWarper::create(method, options.fill, *made.mode_, options.camera(), {.rig = *rig});
    if (!warper) return warper.error();
    made.stereo_ = std::move(*warper);
    return made;
}

void ReplayMethod::prepare(Layer& layer) const { maker().prepare(layer); }

void ReplayMethod::warp(const RenderedFrame& frame, const WarpTarget& target) {
    if (mono_) {
        mono_->warp(frame, target);
    } else {
        stereo_->warp_eyes(frame, target);
    }
}

const FrameWarper& ReplayMethod::eye(std::size_t index) const {
    return mono_ ? *mono_ : stereo_->eye(static_cast<Eye>(index));
}

const PictureMaker& ReplayMethod::maker() const { return mono_ ? static_cast<const PictureMaker&>(*mono_) : *stereo_; }

const WarpCounters& ReplayMethod::counters() const { return maker().counters(); }

void ReplayMethod::report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const {
    maker().report_holes(frame, head, feedback);
}

}  // namespace lw
