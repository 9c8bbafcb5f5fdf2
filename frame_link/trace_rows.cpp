#include "frame_link/trace_rows.h"

#include <algorithm>
#include <cmath>

namespace lw {
namespace {

constexpr double kMaxPosition_m = 1e6;
constexpr double kMaxTime_s = 9e9;  // what from_seconds() can represent
// Rows rounded to three decimals are unit within 0.001; farther away something else is wrong with them.
constexpr double kNormTolerance = 0.01;
// The longest pause in sound recordings is 58 ms (a headset that dropped four frames).
constexpr double kGap_s = 0.1;
constexpr double kGapIntervals = 5.0;  // and in slow recordings, so many times the usual interval

bool is_absurd(const Pose& pose) {
    const glm::dvec3 p = glm::abs(pose.position_m);
    return p.x > kMaxPosition_m || p.y > kMaxPosition_m || p.z > kMaxPosition_m;
}

bool is_finite(double time_s, const Pose& pose) {
    const glm::dvec3& p = pose.position_m;
    const glm::dquat& q = pose.orientation;
    for (const double number : {time_s, p.x, p.y, p.z, q.w, q.x, q.y, q.z}) {
        if (!std::isfinite(number)) return false;
    }
    return true;
}

double median_interval_s(const std::vector<TimedPose>& poses) {
    std::vector<double> intervals_s;
    for (std::size_t i = 1; i < poses.size(); ++i) intervals_s.push_back(poses[i].time_s - poses[i - 1].time_s);
    const auto middle = intervals_s.begin() + static_cast<std::ptrdiff_t>(intervals_s.size() / 2);
    std::nth_element(intervals_s.begin(), middle, intervals_s.end());
    return *middle;
}

}  // namespace

void TraceRows::add(double time_s, const Pose& world_from_head) {
    if (!is_finite(time_s, world_from_head)) return drop("a number is not finite");
    if (is_absurd(world_from_head) || std::abs(time_s) > kMaxTime_s) return drop("a number is beyond all measure");
    const std::optional<Pose> pose = sanitised(world_from_head);
    if (!pose) return drop("no orientation (zero quaternion)");
    if (!poses_.empty() && time_s <= poses_.back().time_s) return drop("time does not advance");
    if (std::abs(glm::length(world_from_head.orientation) - 1.0) > kNormTolerance) ++not_unit_count_;
    ++row_count_;
    poses_.push_back({time_s, *pose});
}

void TraceRows::drop(std::string_view why) {
    ++row_count_;
    ++dropped_count_;
    for (auto& [reason, count] : dropped_) {
        if (reason == why) {
            ++count;
            return;
        }
    }
    dropped_.emplace_back(why, 1);
}

void TraceRows::warn_of_dropped_rows() {
    for (const auto& [reason, count] : dropped_) {
        warn(fmt::format("{} of {} rows dropped: {}", count, row_count_, reason));
    }
    if (not_unit_count_ > 0) warn(fmt::format("{} quaternions were not of unit length: normalised", not_unit_count_));
}

void TraceRows::warn_of_gaps() {
    if (poses_.size() < 3) return;
    const double gap_s = std::max(kGap_s, kGapIntervals * median_interval_s(poses_));
    std::size_t gaps = 0;
    std::size_t longest = 1;
    const auto interval_s = [&](std::size_t i) { return poses_[i].time_s - poses_[i - 1].time_s; };
    for (std::size_t i = 1; i < poses_.size(); ++i) {
        if (interval_s(i) > gap_s) ++gaps;
        if (interval_s(i) > interval_s(longest)) longest = i;
    }
    if (gaps == 0) return;
    warn(fmt::format("{} gap{} without samples, the longest {:.3f} s at {:.3f} s: the pose glides across", gaps,
                     gaps == 1 ? "" : "s", interval_s(longest), poses_[longest - 1].time_s - poses_.front().time_s));
}

Result<Trace> TraceRows::finish(std::string name, const std::string& where) {
    const std::string reason = dropped_.empty() ? "it has no rows" : dropped_.front().first;
    if (poses_.empty()) {
        return Error{fmt::format("no usable pose in the trace ({})", reason), where, "record it again"};
    }
    if (2 * dropped_count_ > row_count_) {
        return Error{
            fmt::format("{} of {} rows of the trace are unusable (first: {})", dropped_count_, row_count_, reason),
            where, "record it again"};
    }
    warn_of_dropped_rows();
    warn_of_gaps();
    return Trace{std::move(name), std::move(poses_), std::move(warnings_)};
}

}  // namespace lw
