#include "frame_link/prediction.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/check.h"
#include "frame_link/adaptive_motion.h"
#include "frame_link/double_exponential.h"
#include "frame_link/kalman_head_filter.h"
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
        const Duration ahead = std::max(target - motion->newest.time, -kVelocityWindow);
        return {motion->pose_after(to_seconds(ahead)), motion->newest.time, motion->newest.number};
    }

private:
    static constexpr std::size_t kUsualCount = 40;  // one window of a 1 kHz tracker, and some unusable samples
    std::array<PoseSample, 320> samples_;           // one window of a 10 kHz tracker, far above any that exists
};

/// A filter that is fed the sound samples of a stream in the order of time.
template <class Filter>
class FilterPredictor final : public HeadPosePredictor {
public:
    PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) override {
        const std::uint64_t before = newest_number();
        const auto fresh = stream_.advance(feed, now);
        if (!stream_.newest()) return newest_usable(feed, now);
        // The stream went back in time and began anew.
        if (!fresh.empty() && fresh.front().number <= before) filter_ = Filter{};
        for (const SoundSample& sample : fresh) filter_.add(sample);
        const SoundSample& newest = *filter_.newest();
        return {filter_.pose_after(std::max(target - newest.time, -kVelocityWindow)), newest.time, newest.number};
    }

private:
    [[nodiscard]] std::uint64_t newest_number() const { return stream_.newest() ? stream_.newest()->number : 0; }

    HeadSampleStream stream_;
    Filter filter_;
};

template <class Predictor>
std::unique_ptr<HeadPosePredictor> make() {
    return std::make_unique<Predictor>();
}

struct PredictorEntry {
    std::string_view name;
    std::unique_ptr<HeadPosePredictor> (*make)();
};
constexpr std::array kPredictors{
    PredictorEntry{"none", make<NoPredictor>},
    PredictorEntry{"constant-velocity", make<ConstantVelocityPredictor>},
    PredictorEntry{"double-exponential", make<FilterPredictor<DoubleExponential>>},
    PredictorEntry{"kalman", make<FilterPredictor<KalmanHeadFilter>>},
    PredictorEntry{"adaptive", make<FilterPredictor<AdaptiveMotion>>},
    PredictorEntry{"oracle", make<OraclePredictor>},
};

}  // namespace

std::vector<std::string_view> predictor_names() {
    std::vector<std::string_view> names;
    for (const PredictorEntry& entry : kPredictors) names.push_back(entry.name);
    return names;
}

Result<std::unique_ptr<HeadPosePredictor>> make_predictor(std::string_view name) {
    std::string known;
    for (const PredictorEntry& entry : kPredictors) {
        if (entry.name == name) return entry.make();
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
    }
    return Error{"unknown predictor", std::string{name}, "use one of " + known};
}

}  // namespace lw
