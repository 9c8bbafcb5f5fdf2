#include "frame_link/head_sample_stream.h"

#include <algorithm>

namespace lw {
namespace {

// Long enough that rounding to millimetres and thousandths does not make a velocity of its own.
constexpr Duration kVelocitySpan = std::chrono::milliseconds{8};
// What noise may add to the distance from where the head was going.
constexpr double kSlack_rad = 0.02;
constexpr double kSlack_m = 0.01;
// Two doubted samples agree when a head could have come from one to the other.
constexpr double kFastestTurn_rad_per_s = 15.0;
constexpr double kFastestMove_m_per_s = 5.0;

bool could_be_one_head(const SoundSample& a, TimePoint time, const Pose& pose) {
    const double seconds = to_seconds(time - a.time);
    return angle_between_rad(a.world_from_head.orientation, pose.orientation) <=
               kSlack_rad + kFastestTurn_rad_per_s * seconds &&
           glm::length(a.world_from_head.position_m - pose.position_m) <= kSlack_m + kFastestMove_m_per_s * seconds;
}

}  // namespace

std::span<const SoundSample> HeadSampleStream::advance(const HeadPoseFeed& feed, TimePoint now) {
    sound_count_ = 0;
    for (std::size_t i = read_new(feed, now); i-- > 0;) {
        last_number_ = read_[i].number;
        if (const auto pose = sanitised(read_[i].world_from_head)) take(read_[i], *pose);
    }
    return {sound_.data(), sound_count_};
}

std::size_t HeadSampleStream::read_new(const HeadPoseFeed& feed, TimePoint now) {
    // Numbers count every sample, so the newest one tells how many there are to read.
    if (feed.newest(now, std::span{read_}.first(1)) == 0) return 0;
    if (read_[0].number < last_number_) begin_anew();
    const std::uint64_t behind = read_[0].number - last_number_;
    if (behind == 0) return 0;
    const bool is_first = last_number_ == 0;
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(is_first ? kMostAtOnce : behind, kMostAtOnce));
    std::size_t count = feed.newest(now, std::span{read_}.first(wanted));
    while (count > 0 && read_[count - 1].number <= last_number_) --count;
    return count;
}

void HeadSampleStream::take(const PoseSample& sample, const Pose& pose) {
    if (!newest_ || sample.time - newest_->time > kGap) return believe(sample, pose, true);
    if (sample.time <= newest_->time) return;
    if (is_credible(sample.time, pose)) return believe(sample, pose, false);

    const bool confirmed = doubted_ && could_be_one_head(*doubted_, sample.time, pose);
    const bool is_over = doubted_ && sample.time - doubt_began_ > kLongestDoubt;
    if (confirmed || is_over) return believe(sample, pose, true);
    if (!doubted_) doubt_began_ = sample.time;
    doubted_ = SoundSample{sample.time, pose, sample.number, false};
}

bool HeadSampleStream::is_credible(TimePoint time, const Pose& pose) const {
    const double seconds = to_seconds(time - newest_->time);
    Pose expected = newest_->world_from_head;
    double slack_s = seconds;
    if (before_) {
        const double span_s = to_seconds(newest_->time - before_->time);
        expected = interpolate(before_->world_from_head, newest_->world_from_head, 1.0 + seconds / span_s);
        slack_s += 0.5 * span_s;  // the velocity is that of the middle of the span
    } else if (could_be_one_head(*newest_, time, pose)) {
        return true;
    }
    const double acceleration_reach = seconds * slack_s;
    return angle_between_rad(expected.orientation, pose.orientation) <=
               kSlack_rad + kLargestTurn_rad_per_s2 * acceleration_reach &&
           glm::length(expected.position_m - pose.position_m) <= kSlack_m + kLargestPush_m_per_s2 * acceleration_reach;
}

void HeadSampleStream::believe(const PoseSample& sample, const Pose& pose, bool restarts) {
    const SoundSample sound{sample.time, pose, sample.number, restarts};
    doubted_.reset();
    if (restarts) {
        before_.reset();
        between_.reset();
    }
    if (!between_) between_ = sound;
    if (sound.time - between_->time >= kVelocitySpan) {
        before_ = between_;
        between_ = newest_;
    }
    newest_ = sound;
    if (sound_count_ < sound_.size()) sound_[sound_count_++] = sound;
}

void HeadSampleStream::begin_anew() {
    last_number_ = 0;
    newest_.reset();
    before_.reset();
    between_.reset();
    doubted_.reset();
}

}  // namespace lw
