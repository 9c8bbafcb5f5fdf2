#include "scene/animation.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace lw::scene {
namespace {

glm::dquat quaternion_of(const glm::dvec4& xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }

glm::dvec4 xyzw_of(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

glm::dvec4 unit_or_identity(const glm::dvec4& xyzw) {
    const double length = glm::length(xyzw);
    return length > 1e-12 ? xyzw / length : glm::dvec4{0.0, 0.0, 0.0, 1.0};
}

/// Values per key: cubic keys hold in-tangent, value, out-tangent.
std::size_t value_stride(const AnimationChannel& channel) {
    return channel.interpolation == Interpolation::cubic ? 3 : 1;
}

glm::dvec4 key_value(const AnimationChannel& channel, std::size_t key) {
    const std::size_t offset = channel.interpolation == Interpolation::cubic ? 1 : 0;
    return channel.values[key * value_stride(channel) + offset];
}

glm::dvec4 linear(const AnimationChannel& channel, std::size_t key, double fraction) {
    const glm::dvec4 before = key_value(channel, key);
    const glm::dvec4 after = key_value(channel, key + 1);
    if (channel.property != AnimatedProperty::rotation) return glm::mix(before, after, fraction);
    return xyzw_of(
        glm::slerp(quaternion_of(unit_or_identity(before)), quaternion_of(unit_or_identity(after)), fraction));
}

/// Cubic Hermite spline; tangents are per second, so they are scaled by the length of the segment.
glm::dvec4 hermite(const AnimationChannel& channel, std::size_t key, double fraction, double segment_s) {
    const double t = fraction;
    const double t2 = t * t;
    const double t3 = t2 * t;
    const glm::dvec4 value_before = key_value(channel, key);
    const glm::dvec4 value_after = key_value(channel, key + 1);
    const glm::dvec4 out_tangent = segment_s * glm::dvec4{channel.values[3 * key + 2]};
    const glm::dvec4 in_tangent = segment_s * glm::dvec4{channel.values[3 * (key + 1)]};
    return (2.0 * t3 - 3.0 * t2 + 1.0) * value_before + (t3 - 2.0 * t2 + t) * out_tangent +
           (3.0 * t2 - 2.0 * t3) * value_after + (t3 - t2) * in_tangent;
}

glm::dvec4 interpolated(const AnimationChannel& channel, double local_s) {
    const std::vector<float>& times = channel.times_s;
    if (local_s <= static_cast<double>(times.front())) return key_value(channel, 0);
    if (local_s >= static_cast<double>(times.back())) return key_value(channel, times.size() - 1);
    const auto after = std::upper_bound(times.begin(), times.end(), local_s,
                                        [](double time, float key) { return time < static_cast<double>(key); });
    const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
    if (channel.interpolation == Interpolation::step) return key_value(channel, key);
    const double start_s = times[key];
    const double segment_s = static_cast<double>(times[key + 1]) - start_s;
    const double fraction = (local_s - start_s) / segment_s;
    if (channel.interpolation == Interpolation::linear) return linear(channel, key, fraction);
    return hermite(channel, key, fraction, segment_s);
}

}  // namespace

double looped_time_s(double time_s, double loop_s) {
    const double remainder = std::fmod(time_s, loop_s);
    if (remainder >= 0.0) return remainder;
    const double from_end = remainder + loop_s;
    return from_end < loop_s ? from_end : 0.0;  // -1e-300 + loop_s rounds to loop_s itself
}

glm::dvec4 channel_value(const AnimationChannel& channel, double time_s) {
    LW_CHECK(!channel.times_s.empty(), "a channel without keys");
    LW_CHECK_EQ(channel.values.size(), channel.times_s.size() * value_stride(channel));
    const glm::dvec4 value = interpolated(channel, looped_time_s(time_s, channel.loop_s));
    return channel.property == AnimatedProperty::rotation ? unit_or_identity(value) : value;
}

}  // namespace lw::scene
