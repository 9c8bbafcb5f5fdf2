#pragma once
/// What the client draws for a display: how many samples, how dense, and how much around it.

#include <optional>

#include "client_renderer/guard_band.h"

namespace lw {

/// The knobs of the source's quality, as the command line names them.
struct SourceSettings {
    int samples_per_axis = 1;                    ///< squared samples per source pixel, resolved per surface: 1, 2 or 4
    double density = 1.0;                        ///< source pixels per target pixel and axis at the centre: at least 1
    std::optional<double> guard_band_rad = 0.0;  ///< per side, >= 0; nothing: sized from the head's rotation
    int layers = 1;                              ///< 2: with a hidden layer (client_renderer/hidden_layer.h)
};

/// `target` with a guard band, and `density` times its pixels in each direction at that field of view (rounded to
/// whole pixels). Pure, any thread.
[[nodiscard]] Camera source_camera(const Camera& target, double density, double guard_band_rad);

/// Source cameras of one client, frame by frame. One thread.
class SourceCameras {
public:
    /// The pose of `target` is ignored.
    SourceCameras(const Camera& target, const SourceSettings& settings);

    /// The source camera of the next frame, with the pose of `target`. Equal calls in equal order give equal cameras.
    /// @param now         when drawing begins; no later pose sample is looked at
    /// @param oldest_age  expected time from now until the frame is shown for the last time
    [[nodiscard]] Camera next(const HeadPoseFeed& head, TimePoint now, Duration oldest_age);

    /// The largest that next() can return.
    [[nodiscard]] Camera largest() const;

private:
    Camera target_;
    SourceSettings settings_;
    std::optional<GuardBandSizer> sizer_;  ///< where the band is not given
};

}  // namespace lw
