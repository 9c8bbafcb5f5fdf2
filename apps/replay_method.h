#pragma once
/// One column of a replay: a warp method for one eye or two, or a picture that needs no warp.

#include <memory>
#include <optional>
#include <string>

#include "apps/options.h"
#include "core/result.h"
#include "warp_server/frame_warper.h"
#include "warp_server/stereo_warper.h"

namespace lw {

class ReplayMethod {
public:
    /// @param label   a warp method; with two eyes also a way to make stereo, which then warps by options.method; or
    ///                `fresh`, `fresh-same`, which warp nothing
    /// @param rig     nothing for one eye
    [[nodiscard]] static Result<ReplayMethod> create(const std::string& label, const Options& options,
                                                     const std::optional<StereoRig>& rig);

    [[nodiscard]] const std::string& label() const { return label_; }
    /// What the client has to draw for it; nothing for one eye.
    [[nodiscard]] std::optional<StereoMode> stereo_mode() const { return mode_; }
    [[nodiscard]] bool warps() const { return mono_.has_value() || stereo_ != nullptr; }

    /// The rest only where it warps.
    void prepare(Layer& layer) const;
    /// `target` is the head's; with one eye its only one.
    void warp(const RenderedFrame& frame, const WarpTarget& target);
    /// The picture of the last warp() for eye `index`, 0 where there is one eye.
    [[nodiscard]] const FrameWarper& eye(std::size_t index) const;
    [[nodiscard]] const WarpCounters& counters() const;
    /// PictureMaker::report_holes() of the last warp().
    void report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const;

private:
    [[nodiscard]] const PictureMaker& maker() const;

    std::string label_;
    std::optional<StereoMode> mode_;
    std::optional<FrameWarper> mono_;
    std::unique_ptr<StereoWarper> stereo_;
};

}  // namespace lw
