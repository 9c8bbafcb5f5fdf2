/// The two sides together: a source with a guard band, warped by every method without moving.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "client_renderer/guard_band.h"
#include "warp_server/methods/registry.h"
#include "warp_server/warp_method.h"

namespace lw::test {

namespace {

Layer noisy_layer(const Camera& camera) {
    std::mt19937 random{1};
    std::uniform_int_distribution<int> byte{0, 255};
    Layer layer;
    layer.camera = camera;
    CpuPixels& pixels = layer.cpu();
    pixels.colour.resize(camera.size_px);
    pixels.depth.resize(camera.size_px);
    pixels.object_id.resize(camera.size_px);
    for (Rgba8& colour : pixels.colour.pixels()) {
        colour = {static_cast<std::uint8_t>(byte(random)), static_cast<std::uint8_t>(byte(random)),
                  static_cast<std::uint8_t>(byte(random)), 255};
    }
    for (float& depth : pixels.depth.pixels()) depth = 0.001F * static_cast<float>(1 + byte(random));
    return layer;
}

TEST(GuardBandWarp, ZeroMotionShowsTheMiddleBitForBit) {
    Camera target;
    target.size_px = {96, 80};
    target.fov = {-1.1, 0.9, -1.0, 0.8};
    target.world_from_eye = {{3.0, 1.6, -2.0}, glm::normalize(glm::dquat{0.9, 0.1, -0.3, 0.2})};
    const Camera source = with_guard_band(target, 0.12);
    Layer layer = noisy_layer(source);
    const double tan_per_px_x = (target.fov.right - target.fov.left) / target.size_px.x;
    const double tan_per_px_y = (target.fov.up - target.fov.down) / target.size_px.y;
    const auto left_px = static_cast<int>(std::lround((target.fov.left - source.fov.left) / tan_per_px_x));
    const auto top_px = static_cast<int>(std::lround((source.fov.up - target.fov.up) / tan_per_px_y));
    ASSERT_GT(left_px, 0);
    ASSERT_GT(top_px, 0);
    for (const MethodEntry& entry : warp_methods()) {
        if (entry.needs_gl) continue;  // no context here
        auto method = make_warp_method(std::string{entry.name});
        ASSERT_TRUE(method.ok()) << entry.name;
        layer.prepared = {{std::string{(*method)->label()}, (*method)->prepare(layer)}};
        DisplayFrame shown;
        (*method)->warp(layer, {target, {}}, shown);
        int different = 0;
        for (int y = 0; y < target.size_px.y; ++y) {
            for (int x = 0; x < target.size_px.x; ++x) {
                different += shown.colour.at(x, y) == layer.cpu().colour.at(left_px + x, top_px + y) ? 0 : 1;
            }
        }
        EXPECT_EQ(different, 0) << entry.name;
    }
}

}  // namespace

}  // namespace lw::test
