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

}  // namespace

void open_partly_covered(DisplayFrame& frame) {
    std::vector<PartlyCovered>& parts = frame.partly_covered;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        prefetch_state(frame, parts[std::min(i + kAhead, parts.size() - 1)].pixel);
        if (is_untouched(frame, parts[i])) parts[kept++] = parts[i];
    }
    parts.resize(kept);
    for (const PartlyCovered& part : frame.partly_covered) frame.coverage.pixels()[part.pixel] = Coverage::hole;
}

void close_partly_covered(DisplayFrame& frame) {
    const std::vector<PartlyCovered>& parts = frame.partly_covered;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const PartlyCovered& part = parts[i];
        const std::uint32_t later = parts[std::min(i + kAhead, parts.size() - 1)].pixel;
        __builtin_prefetch(frame.colour.pixels().data() + later, 1);
        Rgba8& colour = frame.colour.pixels()[part.pixel];
        colour = mixed(colour, part.colour, part.share);
        if (part.share < kReachedShare) continue;
        frame.depth.pixels()[part.pixel] = part.depth;
        frame.coverage.pixels()[part.pixel] = Coverage::reached;
    }
}

}  // namespace lw
