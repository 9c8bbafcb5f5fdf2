#pragma once
/// The guard band: field of view around the source that the display does not show, so that a turning head does not
/// look past the edge of an old frame.

#include <array>
#include <memory>

#include "core/camera.h"
#include "core/clock.h"
#include "frame_link/prediction.h"

namespace lw {

/// Half of what a pinhole camera may see at most, 85 degrees: beyond it pixels grow without bound.
inline constexpr double kWidestHalfAngleRad = 1.4835298641951802;

/// `target` with at least `band_rad` more field of view on each of its four sides, at the same pixels per tangent.
/// Each side grows by a whole number of the target's pixels, so that the pixel grids coincide and a warp that moves
/// nothing copies pixels. A side ends at kWidestHalfAngleRad; one that is there already does not grow.
/// @param band_rad  radians, >= 0; 0 returns `target`
/// Pure, any thread.
[[nodiscard]] Camera with_guard_band(const Camera& target, double band_rad);

/// Pixels of `source` over those of `target`.
[[nodiscard]] double pixels_ratio(const Camera& source, const Camera& target);

/// The widest band, in radians, with which `target` takes at most `max_ratio` >= 1 times its pixels. Pure, any thread.
[[nodiscard]] double widest_guard_band_rad(const Camera& target, double max_ratio);

/// Sizes the guard band from the head's rotation: how far it turns, at its speed of now, until the frame drawn now is
/// no longer shown.
///
/// The band is one of three steps: none, half of and the whole of what doubles the pixels (about 10 degrees per side
/// at 90). So the picture's size, and with it the cost of a frame and the memory of everybody downstream, changes
/// seldom; a band of every frame's own size would make new textures for every frame. It grows at once, and shrinks one
/// step at a time, when a band would do that is smaller by a third: a head that swings about a limit does not make it
/// swing. One thread.
class GuardBandSizer {
public:
    static constexpr double kMostPixels = 2.0;
    /// Slower turns until the frame's end need no band: a quarter of a degree is 1 px of 512 at 90 degrees.
    static constexpr double kNoTurnRad = 0.0044;
    static constexpr double kShrinkBelow = 2.0 / 3.0;

    explicit GuardBandSizer(const Camera& target);

    /// The band of a frame whose drawing begins at `now`, from pose samples up to then.
    /// @param oldest_age  expected time from now until the frame is shown for the last time
    /// @return radians per side
    [[nodiscard]] double next_rad(const HeadPoseFeed& head, TimePoint now, Duration oldest_age);

private:
    std::array<double, 3> steps_rad_{};
    std::size_t step_ = 0;
    std::unique_ptr<HeadPosePredictor> predictor_;
};

}  // namespace lw
