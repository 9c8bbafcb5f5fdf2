#pragma once
/// What makes the picture of a refresh from a rendered frame: for one eye FrameWarper, for two StereoWarper.

#include <cstdint>

#include "frame_link/hole_feedback.h"
#include "frame_link/rendered_frame.h"
#include "warp_server/warp_method.h"

namespace lw {

/// Input that could not be used, by kind; it is passed over, never fatal.
struct HeldInput {
    std::uint64_t bad_head_pose = 0;  ///< pictures whose head pose was none: the last good one held
    std::uint64_t bad_placement = 0;  ///< movers whose placement at photon time was none: their last good one held
    std::uint64_t bad_layer = 0;      ///< layers whose camera was none: left out

    HeldInput& operator+=(const HeldInput& other) {
        bad_head_pose += other.bad_head_pose;
        bad_placement += other.bad_placement;
        bad_layer += other.bad_layer;
        return *this;
    }
};

class PictureMaker {
public:
    virtual ~PictureMaker() = default;

    /// Client's thread, before the layer is published.
    virtual void prepare(Layer& layer) const = 0;

    /// Everything that the refresh shows comes from this frame, this head pose and these placements. The result is
    /// valid until the next call. Server thread.
    virtual const DisplayFrame& warp(const RenderedFrame& frame, const WarpTarget& target) = 0;

    /// Of the last warp(): pixels that could not be used, and what else could not.
    [[nodiscard]] virtual const WarpCounters& counters() const = 0;
    [[nodiscard]] virtual const HeldInput& held() const = 0;

    /// The picture of the last warp().
    [[nodiscard]] virtual const DisplayFrame& display_frame() const = 0;
    /// The same, to write over it what belongs to the display and not to the scene (photon codes, an overlay). It is
    /// not shown again after that.
    [[nodiscard]] virtual DisplayFrame& display_frame_to_write_over() = 0;

    /// Adds what the last warp(), of this frame for this head, did not reach (attribute_holes()): of each eye one
    /// display frame.
    virtual void report_holes(const RenderedFrame& frame, const Camera& head, HoleFeedback& feedback) const = 0;
};

}  // namespace lw
