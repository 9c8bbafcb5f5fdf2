#pragma once
/// Head-pose prediction from the newest samples; the client and the server use the same one.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "frame_link/feeds.h"

namespace lw {

/// A predicted pose and the sample it rests on.
struct PredictedPose {
    Pose world_from_head;
    TimePoint newest_sample;  ///< stamp of the newest sample used: motion-to-photon counts from here
    std::uint64_t sample_number = 0;
};

/// Keeps only what it reads from the feed, so one predictor belongs to one thread.
class HeadPosePredictor {
public:
    virtual ~HeadPosePredictor() = default;
    /// The pose at `target`, from samples stamped at or before `now`. Always finite and unit; an unusable sample is
    /// passed over. Before the feed's first sample: the identity.
    [[nodiscard]] virtual PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) = 0;
};

/// Names that make_predictor() accepts: none, constant-velocity, oracle (needs a ForeseeingHeadPoseFeed).
[[nodiscard]] std::vector<std::string_view> predictor_names();
[[nodiscard]] Result<std::unique_ptr<HeadPosePredictor>> make_predictor(std::string_view name);

}  // namespace lw
