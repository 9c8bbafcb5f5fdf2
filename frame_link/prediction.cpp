#include "frame_link/prediction.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/check.h"
#include "frame_link/velocity_fit.h"

namespace lw {
namespace {

/// The newest usable sample stamped at or before `now`, looked for among the last few.
PredictedPose newest_usable(const HeadPoseFeed& feed, TimePoint now) {
    std::array<PoseSample, 16> samples;
    const std::size_t count = feed.newest(now, samples);
    for (std::size_t i = 0; i < count; ++i) {
        if (const auto pose = sanitised(samples[i].world_from_head)) {
            return {*pose, samples[i].time, samples[i].number};
        }
    }
    return {Pose{}, now, 0};
}

class NoPredictor final : public HeadPosePredictor {
public:
    PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint /*target*/) override {
        return newest_usable(feed, now);
    }
};

class OraclePredictor final : public HeadPosePredictor {
public:
    PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) override {
        const auto* recording = dynamic_cast<const ForeseeingHeadPoseFeed*>(&feed);
        LW_CHECK(recording != nullptr, "the oracle needs a feed that knows the future");
        PredictedPose predicted = newest_usable(feed, now);
        if (const auto pose = sanitised(recording->pose_at(target))) predicted.world_from_head = *pose;
        return predicted;
    }
};

class ConstantVelocityPredictor final : public HeadPosePredictor {
public:
    PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) override {
        std::size_t count = feed.newest(now, std::span{samples_}.first(kUsualCount));
        const bool is_short = count == kUsualCount && samples_[0].time - samples_[count - 1].time < kVelocityWindow;
        if (is_short) count = feed.newest(now, samples_);
        const auto motion = fit_velocity({samples_.data(), count});
        if (!motion) return {Pose{}, now, 0};
        const Duration ahead = std::clamp(target - motion->newest.time, -kVelocityWindow, kVelocityHorizon);
        return {motion->pose_after(to_seconds(ahead)), motion->newest.time, motion->newest.number};
    }

private:
    static constexpr std::size_t kUsualCount = 40;  // one window of a 1 kHz tracker, and some unusable samples
    std::array<PoseSample, 320> samples_;           // one window of a 10 kHz tracker, far above any that exists
};

}  // namespace

std::vector<std::string_view> predictor_names() { return {"none", "constant-velocity", "oracle"}; }

Result<std::unique_ptr<HeadPosePredictor>> make_predictor(std::string_view name) {
    using Made = std::unique_ptr<HeadPosePredictor>;
    if (name == "none") return Made{std::make_unique<NoPredictor>()};
    if (name == "constant-velocity") return Made{std::make_unique<ConstantVelocityPredictor>()};
    if (name == "oracle") return Made{std::make_unique<OraclePredictor>()};
    return Error{"unknown predictor", std::string{name}, "use none, constant-velocity or oracle"};
}

}  // namespace lw
