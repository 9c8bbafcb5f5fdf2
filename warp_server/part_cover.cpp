#include "warp_server/part_cover.h"

#include <algorithm>
#include <array>

#include "core/colour.h"
#include "warp_server/methods/linear_colour.h"

namespace lw {
namespace {

constexpr float kReachedShare = 0.5F;

void prefetch_state(const DisplayFrame& frame, std::uint32_t pixel) {
    __builtin_prefetch(frame.coverage.pixels().data() + pixel, 1);
    __builtin_prefetch(frame.depth.pixels().data() + pixel, 1);
}

// Is the pixel still as its method left it?
bool is_untouched(const DisplayFrame& frame, const PartlyCovered& part) {
    const Coverage coverage = frame.coverage.pixels()[part.pixel];
    if (part.share < kReachedShare) return coverage == Coverage::hole;
    return coverage == Coverage::reached && frame.depth.pixels()[part.pixel] == part.depth;
}

Rgba8 mixed(Rgba8 back, Rgba8 front, float share) {
    const std::array<float, 256>& linear = linear_from_srgb8_table();
    const SrgbParabolas& parabolas = srgb_parabolas();
    const auto mix = [&](std::uint8_t Rgba8::*channel) {
        const float mean = linear[back.*channel] + share * (linear[front.*channel] - linear[back.*channel]);
        return srgb8_from_linear15(static_cast<std::int32_t>(static_cast<float>(kLinearOne) * mean + 0.5F), parabolas);
    };
    return {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), 255};
}

// The pixels lie all over the picture: a line of it is asked for that many of them ahead.
constexpr std::size_t kAhead = 16;

// Fewer are done before another thread has woken.
constexpr std::size_t kWorthThreads = 2048;

void drop_touched(DisplayFrame& frame, PartCover::Pixels share) {
    std::vector<PartlyCovered>& parts = frame.partly_covered;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::uint32_t later = parts[std::min(i + kAhead, parts.size() - 1)].pixel;
        if (share.holds(later)) prefetch_state(frame, later);
        if (share.holds(parts[i].pixel) && !is_untouched(frame, parts[i])) parts[i].share = 0.0F;
    }
}

void open_untouched(DisplayFrame& frame, PartCover::Pixels share) {
    for (const PartlyCovered& part : frame.partly_covered) {
        if (share.holds(part.pixel) && part.share > 0.0F) frame.coverage.pixels()[part.pixel] = Coverage::hole;
    }
}

void close_opened(DisplayFrame& frame, PartCover::Pixels share) {
    const std::vector<PartlyCovered>& parts = frame.partly_covered;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::uint32_t later = parts[std::min(i + kAhead, parts.size() - 1)].pixel;
        if (share.holds(later)) __builtin_prefetch(frame.colour.pixels().data() + later, 1);
        const PartlyCovered& part = parts[i];
        if (!share.holds(part.pixel) || !(part.share > 0.0F)) continue;
        Rgba8& colour = frame.colour.pixels()[part.pixel];
        colour = mixed(colour, part.colour, part.share);
        if (part.share < kReachedShare) continue;
        frame.depth.pixels()[part.pixel] = part.depth;
        frame.coverage.pixels()[part.pixel] = Coverage::reached;
    }
}

}  // namespace

PartCover::PartCover(TaskPool* threads)
    : threads_{threads},
      open_share_{[this](int task, int /*worker*/) {
          drop_touched(*frame_, share_of(task));
          open_untouched(*frame_, share_of(task));
      }},
      close_share_{[this](int task, int /*worker*/) { close_opened(*frame_, share_of(task)); }} {}

void PartCover::open(DisplayFrame& frame) { run(frame, open_share_); }

void PartCover::close(DisplayFrame& frame) { run(frame, close_share_); }

// Methods leave the entries about in the order of their pixels, so that equal stretches of the list make equal shares.
void PartCover::run(DisplayFrame& frame, const TaskPool::Work& work) {
    const std::vector<PartlyCovered>& parts = frame.partly_covered;
    const bool alone = threads_ == nullptr || parts.size() < kWorthThreads;
    const auto tasks = alone ? std::size_t{1} : static_cast<std::size_t>(threads_->threads());
    frame_ = &frame;
    borders_.resize(tasks + 1);
    for (std::size_t i = 1; i < tasks; ++i) borders_[i] = parts[parts.size() * i / tasks].pixel;
    borders_.front() = 0;
    borders_.back() = static_cast<std::uint32_t>(frame.colour.pixels().size());
    std::ranges::sort(borders_);
    if (alone) return work(0, 0);
    threads_->run(static_cast<int>(tasks), work);
}

}  // namespace lw
