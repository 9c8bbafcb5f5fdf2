/// Both eyes of a display frame come from one rendered frame and one head pose, however fast the client publishes and
/// the head moves. Run under ThreadSanitizer too. No GL, no real time.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <thread>

#include "tests/warp_server/simulated_display.h"
#include "warp_server/server_loop.h"
#include "warp_server/stereo_warper.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

constexpr double kIpd_m = 0.0625;  // a power of two: differences of positions are exact

// Copies the number in the layer's first pixel to the picture's, and writes beside it where the eye and the mover were.
class OriginMethod final : public WarpMethod {
public:
    [[nodiscard]] std::string_view label() const override { return "origin"; }
    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        out.resize(target.camera.size_px);
        std::ranges::copy(layer.cpu().colour.pixels(), out.colour.pixels().begin());
        std::ranges::fill(out.coverage.pixels(), Coverage::reached);
        const auto x_m = static_cast<float>(target.camera.world_from_eye.position_m.x);
        out.colour.at(1, 0) = std::bit_cast<Rgba8>(x_m);
        const auto mover_m = static_cast<float>(target.movers.front().world_from_object[3][0]);
        out.colour.at(2, 0) = std::bit_cast<Rgba8>(mover_m);
    }
};

// A mover whose placement is another one at every call.
class RestlessMovers final : public ObjectTransformFeed {
public:
    void placements_at(TimePoint /*time*/, std::vector<ObjectTransform>& transforms) const override {
        transforms.assign(1, {1, glm::dmat4{1.0}});
        transforms[0].world_from_object[3][0] = static_cast<double>(++calls_);
    }

private:
    mutable std::atomic<int> calls_{0};
};

std::shared_ptr<const Layer> numbered_layer(std::uint32_t number, std::optional<Eye> eye) {
    auto layer = std::make_shared<Layer>();
    layer->for_eye = eye;
    layer->camera.size_px = {4, 4};
    layer->pixels = CpuPixels{ColourImage{{4, 4}}, DepthImage{{4, 4}}, ObjectIdImage{{4, 4}}};
    layer->cpu().colour.at(0, 0) = std::bit_cast<Rgba8>(number);
    return layer;
}

std::shared_ptr<const RenderedFrame> numbered_frame(std::uint32_t number, StereoMode mode) {
    auto frame = std::make_shared<RenderedFrame>();
    frame->index = number;
    if (mode == StereoMode::two_renders) {
        for (const Eye eye : kEyes) frame->layers.push_back(numbered_layer(number, eye));
    } else {
        frame->layers.push_back(numbered_layer(number, {}));
    }
    return frame;
}

template <class T>
T read_at(const ColourImage& picture, int x) {
    return std::bit_cast<T>(picture.at(x, 0));
}

// Looks at every picture on its way to the display.
class PairWatch final : public Presenter {
public:
    explicit PairWatch(VirtualDisplay& display) : display_{display} {}
    [[nodiscard]] Refresh next_refresh(TimePoint now) const override { return display_.next_refresh(now); }
    void present(const DisplayFrame& frame, const Refresh& refresh) override {
        const ColourImage& both = frame.colour;  // side by side, 4 px each
        if (read_at<std::uint32_t>(both, 0) != read_at<std::uint32_t>(both, 4)) ++frames_apart;
        if (read_at<float>(both, 5) - read_at<float>(both, 1) != static_cast<float>(kIpd_m)) ++poses_apart;
        if (read_at<float>(both, 2) != read_at<float>(both, 6)) ++movers_apart;
        display_.present(frame, refresh);
    }
    void present_strip(const DisplayFrame&, const Refresh&, const Strip&) override {}

    int frames_apart = 0;
    int poses_apart = 0;
    int movers_apart = 0;

private:
    VirtualDisplay& display_;
};

class StereoServer : public testing::TestWithParam<StereoMode> {};

TEST_P(StereoServer, BothEyesAreOfOneFrameAndOnePoseWhileTheClientRacesAhead) {
    constexpr std::size_t kRefreshes = 300;
    test::SimulatedClock clock;
    FrameExchange exchange;
    // Another pose at every call: 1 m farther, whatever the time.
    std::atomic<int> calls{0};
    const test::FormulaHeadFeed head{[&](TimePoint) { return Pose{{static_cast<double>(++calls), 0.0, 0.0}}; }};
    const RestlessMovers movers;
    test::NewestSample predictor;
    const auto eye_warper = [] {
        return FrameWarper{std::make_unique<OriginMethod>(), std::make_unique<test::NoFill>()};
    };
    StereoWarper warper{eye_warper(), eye_warper(), {.rig = mirrored_rig(kIpd_m, FovTangents{}), .parallel = true}};
    VirtualDisplay display{TimePoint{}, 90.0, {8, 4}};
    PairWatch watch{display};
    ServerSettings settings;
    settings.camera.size_px = {4, 4};
    ServerLoop server{ServerParts{clock, exchange, head, movers, predictor, warper, watch}, settings};

    std::atomic<bool> client_may_stop{false};
    std::thread client{[&] {
        for (std::uint32_t number = 1; !client_may_stop.load(); ++number) {
            exchange.publish(numbered_frame(number, GetParam()));
        }
    }};
    // On one core the client may not run at all for a while.
    while (server.records().size() < kRefreshes || server.frames_shown() < 10) {
        server.show_next();
        std::this_thread::yield();
    }
    client_may_stop = true;
    client.join();

    EXPECT_EQ(watch.frames_apart, 0);
    EXPECT_EQ(watch.poses_apart, 0);
    EXPECT_EQ(watch.movers_apart, 0);
}

INSTANTIATE_TEST_SUITE_P(Modes, StereoServer, testing::Values(StereoMode::one_render, StereoMode::two_renders));

}  // namespace
}  // namespace lw
