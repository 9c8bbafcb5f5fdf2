#include "frame_link/sampled_head_feed.h"

#include <bit>

namespace lw {
namespace {

using Words = std::array<std::uint64_t, 8>;

Words words_of(TimePoint time, const Pose& pose) {
    const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
    const glm::dvec3& p = pose.position_m;
    const glm::dquat& q = pose.orientation;
    return {std::bit_cast<std::uint64_t>(time.time_since_epoch().count()),
            bits(p.x),
            bits(p.y),
            bits(p.z),
            bits(q.w),
            bits(q.x),
            bits(q.y),
            bits(q.z)};
}

PoseSample sample_of(const Words& words, std::uint64_t number) {
    const auto value = [&](std::size_t i) { return std::bit_cast<double>(words[i]); };
    return {TimePoint{Duration{std::bit_cast<Duration::rep>(words[0])}},
            Pose{{value(1), value(2), value(3)}, {value(4), value(5), value(6), value(7)}}, number};
}

}  // namespace

// A sequence lock without fences (which ThreadSanitizer does not model): the words are stored with release after the
// odd version, so a reader that acquires a new word also sees that the version moved.
bool SampledHeadFeed::push(TimePoint time, const Pose& world_from_head) {
    const std::optional<Pose> pose = sanitised(world_from_head);
    const std::uint64_t number = newest_number_.load(std::memory_order_relaxed) + 1;
    if (!pose || (number > 1 && time <= newest_time_)) return false;
    Slot& slot = slots_[number % kCapacity];
    slot.version.store(2 * number - 1, std::memory_order_relaxed);
    const Words words = words_of(time, *pose);
    for (std::size_t i = 0; i < kWords; ++i) slot.words[i].store(words[i], std::memory_order_release);
    slot.version.store(2 * number, std::memory_order_release);
    newest_number_.store(number, std::memory_order_release);
    newest_time_ = time;
    return true;
}

bool SampledHeadFeed::read(std::uint64_t number, PoseSample& sample) const {
    const Slot& slot = slots_[number % kCapacity];
    if (slot.version.load(std::memory_order_acquire) != 2 * number) return false;
    Words words;
    for (std::size_t i = 0; i < kWords; ++i) words[i] = slot.words[i].load(std::memory_order_acquire);
    if (slot.version.load(std::memory_order_relaxed) != 2 * number) return false;
    sample = sample_of(words, number);
    return true;
}

std::size_t SampledHeadFeed::newest(TimePoint now, std::span<PoseSample> samples) const {
    std::size_t filled = 0;
    for (std::uint64_t number = newest_number_.load(std::memory_order_acquire); number > 0 && filled < samples.size();
         --number) {
        if (!read(number, samples[filled])) break;
        if (samples[filled].time <= now) ++filled;
    }
    return filled;
}

}  // namespace lw
