#include "warp_server/part_cover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "warp_server/fill.h"

namespace lw::test {
namespace {

// Pixels of noise, a third of them covered in part, as one layer or two leave them.
DisplayFrame frame_with_parts(int layers) {
    DisplayFrame frame;
    frame.resize({160, 90});
    std::mt19937 random{3};
    const auto colour = [&] {
        const auto bits = static_cast<std::uint32_t>(random());
        return Rgba8{static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8U),
                     static_cast<std::uint8_t>(bits >> 16U), 255};
    };
    std::ranges::generate(frame.colour.pixels(), colour);
    std::ranges::fill(frame.depth.pixels(), 0.01F);
    std::ranges::fill(frame.coverage.pixels(), Coverage::reached);
    for (int layer = 0; layer < layers; ++layer) {
        for (std::uint32_t pixel = 0; pixel < frame.colour.pixels().size(); pixel += 3) {
            const float share = static_cast<float>(1 + random() % 99) / 100.0F;
            frame.partly_covered.push_back({pixel, share, 0.02F, colour()});
            frame.coverage.pixels()[pixel] = share < 0.5F ? Coverage::hole : Coverage::reached;
            frame.depth.pixels()[pixel] = share < 0.5F ? -1.0F : 0.02F;
        }
    }
    return frame;
}

DisplayFrame filled(DisplayFrame frame, TaskPool* threads) {
    PartCover parts{threads};
    parts.open(frame);
    (*make_fill("nearest-background"))->apply(frame, {});
    parts.close(frame);
    return frame;
}

TEST(PartCover, AnyNumberOfThreadsGivesTheSamePicture) {
    for (const int layers : {1, 2}) {
        const DisplayFrame alone = filled(frame_with_parts(layers), nullptr);
        for (const int threads : {1, 2, 3}) {
            TaskPool pool{threads};
            const DisplayFrame shared = filled(frame_with_parts(layers), &pool);
            EXPECT_EQ(shared.colour, alone.colour) << layers << " layers, " << threads << " threads";
            EXPECT_EQ(shared.depth, alone.depth);
            EXPECT_EQ(shared.coverage, alone.coverage);
        }
    }
}

TEST(PartCover, WhatALaterLayerCoversStaysAsItIs) {
    DisplayFrame frame;
    frame.resize({2, 1});
    std::ranges::fill(frame.colour.pixels(), Rgba8{10, 20, 30, 255});
    std::ranges::fill(frame.depth.pixels(), 0.5F);
    std::ranges::fill(frame.coverage.pixels(), Coverage::reached);
    frame.partly_covered = {{0, 0.7F, 0.02F, {200, 200, 200, 255}}, {1, 0.3F, 0.02F, {200, 200, 200, 255}}};
    const DisplayFrame shown = filled(frame, nullptr);
    EXPECT_EQ(shown.colour, frame.colour);
    EXPECT_EQ(shown.depth, frame.depth);
}

}  // namespace
}  // namespace lw::test
