#include "warp_server/part_cover.h"

#include <array>

#include "core/colour.h"

namespace lw {
namespace {

constexpr float kReachedShare = 0.5F;

// Is the pixel still as its method left it?
bool is_untouched(const DisplayFrame& frame, const PartlyCovered& part) {
    const Coverage coverage = frame.coverage.pixels()[part.pixel];
    if (part.share < kReachedShare) return coverage == Coverage::hole;
    return coverage == Coverage::reached && frame.depth.pixels()[part.pixel] == part.depth;
}

Rgba8 mixed(Rgba8 back, Rgba8 front, float share) {
    const std::array<float, 256>& linear = linear_from_srgb8_table();
    const auto mix = [&](std::uint8_t Rgba8::*channel) {
        return srgb8_from_linear(linear[back.*channel] + share * (linear[front.*channel] - linear[back.*channel]));
    };
    return {mix(&Rgba8::r), mix(&Rgba8::g), mix(&Rgba8::b), 255};
}

}  // namespace

void open_partly_covered(DisplayFrame& frame) {
    std::erase_if(frame.partly_covered, [&](const PartlyCovered& part) { return !is_untouched(frame, part); });
    for (const PartlyCovered& part : frame.partly_covered) frame.coverage.pixels()[part.pixel] = Coverage::hole;
}

void close_partly_covered(DisplayFrame& frame) {
    for (const PartlyCovered& part : frame.partly_covered) {
        Rgba8& colour = frame.colour.pixels()[part.pixel];
        colour = mixed(colour, part.colour, part.share);
        if (part.share < kReachedShare) continue;
        frame.depth.pixels()[part.pixel] = part.depth;
        frame.coverage.pixels()[part.pixel] = Coverage::reached;
    }
}

}  // namespace lw
