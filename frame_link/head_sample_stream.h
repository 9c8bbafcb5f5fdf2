#pragma once
/// A tracker's new samples in order, without those that cannot be true: what the filters among the predictors are fed.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "frame_link/feeds.h"

namespace lw {

/// A sample that was believed.
struct SoundSample {
    TimePoint time;
    Pose world_from_head;  ///< finite, unit quaternion
    std::uint64_t number = 0;
    bool restarts = false;  ///< the first, after a gap, or at another place after a jump: what was before says nothing
};

/// Follows one feed. One thread; no allocation.
///
/// A sample is passed over when its pose is unusable, when its time does not advance, or when it lies farther from
/// where the head was going than a head can get (kLargestTurn_rad_per_s2, kLargestPush_m_per_s2). Two such samples in
/// a row that agree with each other are a jump of the tracker and believed, and so is anything after kLongestDoubt.
class HeadSampleStream {
public:
    /// What has come since the last call, stamped at or before `now`, oldest first. Valid until the next call. Going
    /// back in time, or to another feed, begins anew with the feed's newest kMostAtOnce samples.
    [[nodiscard]] std::span<const SoundSample> advance(const HeadPoseFeed& feed, TimePoint now);

    /// The newest sample believed so far.
    [[nodiscard]] const std::optional<SoundSample>& newest() const { return newest_; }

    static constexpr std::size_t kMostAtOnce = 512;  ///< half a second of a 1 kHz tracker
    /// A pause longer than this is a gap: five samples of a 50 Hz tracker.
    static constexpr Duration kGap = std::chrono::milliseconds{100};
    static constexpr Duration kLongestDoubt = std::chrono::milliseconds{30};
    /// The recordings of fast turns reach 8000 degrees/s^2.
    static constexpr double kLargestTurn_rad_per_s2 = 140.0;
    static constexpr double kLargestPush_m_per_s2 = 50.0;

private:
    [[nodiscard]] std::size_t read_new(const HeadPoseFeed& feed, TimePoint now);
    void take(const PoseSample& sample, const Pose& pose);
    [[nodiscard]] bool is_credible(TimePoint time, const Pose& pose) const;
    void believe(const PoseSample& sample, const Pose& pose, bool restarts);
    void begin_anew();

    std::array<PoseSample, kMostAtOnce> read_;    ///< newest first
    std::array<SoundSample, kMostAtOnce> sound_;  ///< oldest first
    std::size_t sound_count_ = 0;
    std::uint64_t last_number_ = 0;  ///< read, believed or not
    std::optional<SoundSample> newest_;
    std::optional<SoundSample> before_;   ///< believed at least kVelocitySpan before the newest: tells the velocity
    std::optional<SoundSample> between_;  ///< becomes before_ when it is old enough
    std::optional<SoundSample> doubted_;  ///< the last sample that was not believed
    TimePoint doubt_began_;
};

}  // namespace lw
