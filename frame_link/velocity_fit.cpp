#include "frame_link/velocity_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lw {
namespace {

// 16 samples spread over the window: 120 pairs per component, a few microseconds in all.
constexpr std::size_t kMaxPoints = 16;
constexpr std::size_t kMinPoints = 3;
constexpr Duration kMaxAge = std::chrono::milliseconds{250};
// A newest sample farther than this off the line of the others is a glitch. The hardest head turns (8000 deg/s^2) bend
// off a line by 0.6 degrees over the window, and four median deviations leave room for what is smoothly bent.
constexpr double kGlitch_rad = 0.02;
constexpr double kGlitch_m = 0.01;
constexpr double kGlitchDeviations = 4.0;

/// The window's samples relative to the newest, one array per component so that medians can be taken of each.
struct Points {
    std::size_t count = 0;
    std::array<double, kMaxPoints> time_s{};
    std::array<std::array<double, kMaxPoints>, 6> component{};  ///< position (world, m), rotation vector (head, rad)
};

double median(std::span<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

double median_slope(const Points& points, const std::array<double, kMaxPoints>& values) {
    std::array<double, kMaxPoints*(kMaxPoints - 1) / 2> slopes{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < points.count; ++i) {
        for (std::size_t j = i + 1; j < points.count; ++j) {
            slopes[count++] = (values[i] - values[j]) / (points.time_s[i] - points.time_s[j]);
        }
    }
    return median({slopes.data(), count});
}

/// Where the line of that slope says the newest value (0 as measured) should be: 0 unless it is a glitch.
double mended_newest(const Points& points, const std::array<double, kMaxPoints>& values, double slope, double glitch) {
    std::array<double, kMaxPoints> offsets{};
    for (std::size_t i = 0; i < points.count; ++i) offsets[i] = values[i] - slope * points.time_s[i];
    std::array<double, kMaxPoints> sorted = offsets;
    const double on_line = median({sorted.data(), points.count});
    for (std::size_t i = 0; i < points.count; ++i) sorted[i] = std::abs(offsets[i] - on_line);
    const double deviation = median({sorted.data(), points.count});
    return std::abs(on_line) > std::max(glitch, kGlitchDeviations * deviation) ? on_line : 0.0;
}

/// Usable samples within the window, their count first, so that they can be thinned evenly.
template <class Take>
void for_each_in_window(std::span<const PoseSample> samples, const PoseSample& newest, Take take) {
    TimePoint last = newest.time + Duration{1};
    std::size_t count = 0;
    for (const PoseSample& sample : samples) {
        const Duration age = newest.time - sample.time;
        if (age > kMaxAge || (age > kVelocityWindow && count >= kMinPoints)) return;
        if (sample.time >= last || !sanitised(sample.world_from_head)) continue;
        last = sample.time;
        take(count++, sample);
    }
}

Points gather(std::span<const PoseSample> samples, const PoseSample& newest, const Pose& newest_pose) {
    std::size_t total = 0;
    for_each_in_window(samples, newest, [&](std::size_t, const PoseSample&) { ++total; });
    const std::size_t stride = std::max<std::size_t>(1, (total + kMaxPoints - 1) / kMaxPoints);
    Points points;
    for_each_in_window(samples, newest, [&](std::size_t i, const PoseSample& sample) {
        if (i % stride != 0) return;
        const Pose pose = *sanitised(sample.world_from_head);
        const glm::dvec3 moved = pose.position_m - newest_pose.position_m;
        const glm::dvec3 turned = rotation_vector(glm::conjugate(newest_pose.orientation) * pose.orientation);
        points.time_s[points.count] = to_seconds(sample.time - newest.time);
        for (int axis = 0; axis < 3; ++axis) {
            points.component[static_cast<std::size_t>(axis)][points.count] = moved[axis];
            points.component[static_cast<std::size_t>(axis) + 3][points.count] = turned[axis];
        }
        ++points.count;
    });
    return points;
}

}  // namespace

double steady_span(double seconds) {
    constexpr double kSteady_s = to_seconds(kSteadySpan);
    constexpr double kDecay_s = to_seconds(kVelocityDecay);
    if (seconds <= kSteady_s) return seconds;
    return kSteady_s + kDecay_s * (1.0 - std::exp((kSteady_s - seconds) / kDecay_s));
}

Pose HeadMotionFit::pose_after(double seconds) const {
    const double span_s = steady_span(seconds);
    return {pose.position_m + velocity_m_per_s * span_s,
            glm::normalize(pose.orientation * from_rotation_vector(velocity_rad_per_s_head * span_s))};
}

std::optional<HeadMotionFit> fit_velocity(std::span<const PoseSample> samples) {
    std::size_t first = 0;
    while (first < samples.size() && !sanitised(samples[first].world_from_head)) ++first;
    if (first == samples.size()) return std::nullopt;

    HeadMotionFit fit;
    fit.newest = samples[first];
    fit.pose = *sanitised(fit.newest.world_from_head);
    const Points points = gather(samples.subspan(first), fit.newest, fit.pose);
    if (points.count < 2) return fit;

    glm::dvec3 mend_m{0.0};
    glm::dvec3 mend_rad{0.0};
    for (int axis = 0; axis < 3; ++axis) {
        const auto& moved = points.component[static_cast<std::size_t>(axis)];
        const auto& turned = points.component[static_cast<std::size_t>(axis) + 3];
        fit.velocity_m_per_s[axis] = median_slope(points, moved);
        fit.velocity_rad_per_s_head[axis] = median_slope(points, turned);
        mend_m[axis] = mended_newest(points, moved, fit.velocity_m_per_s[axis], kGlitch_m);
        mend_rad[axis] = mended_newest(points, turned, fit.velocity_rad_per_s_head[axis], kGlitch_rad);
    }
    fit.pose.position_m += mend_m;
    fit.pose.orientation = glm::normalize(fit.pose.orientation * from_rotation_vector(mend_rad));
    return fit;
}

}  // namespace lw
