/// Client and server on threads of their own, as live; run under ThreadSanitizer too. No GL, no real time.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/warp_server/simulated_display.h"
#include "warp_server/frame_warper.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {
namespace {

// Reads every pixel of the layer, and counts frames whose pixels are not all of one colour.
class TearingWatch final : public WarpMethod {
public:
    explicit TearingWatch(test::SimulatedClock& clock) : clock_{clock} {}
    [[nodiscard]] std::string_view label() const override { return "watch"; }
    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        out.resize(target.camera.size_px);
        const auto source = layer.cpu().colour.pixels();
        std::copy(source.begin(), source.end(), out.colour.pixels().begin());
        const bool torn = std::any_of(source.begin(), source.end(), [&](Rgba8 pixel) { return pixel != source[0]; });
        if (torn) ++torn_frames;
        clock_.advance(from_ms(2.0));
    }
    std::atomic<int> torn_frames{0};

private:
    test::SimulatedClock& clock_;
};

TEST(ServerLoopThreads, FramesArriveWholeAndInOrderWhileTheClientRacesAhead) {
    constexpr int kRefreshes = 400;
    test::SimulatedClock clock;
    FrameExchange exchange;
    const test::FormulaHeadFeed head{[](TimePoint) { return Pose{}; }};
    const test::StillMovers movers{2};
    test::NewestSample predictor;
    auto method = std::make_unique<TearingWatch>(clock);
    const TearingWatch& watch = *method;
    FrameWarper warper{std::move(method), std::make_unique<test::NoFill>()};
    VirtualDisplay display{TimePoint{}, 90.0, {4, 4}};
    ServerSettings settings;
    settings.camera.size_px = {4, 4};
    ServerLoop server{ServerParts{clock, exchange, head, movers, predictor, warper, display}, settings};

    std::atomic<bool> client_may_stop{false};
    std::thread client{[&] {
        for (std::uint64_t index = 1; !client_may_stop.load(); ++index) {
            const auto level = static_cast<std::uint8_t>(index);
            exchange.publish(test::plain_frame(index, TimePoint{}, Rgba8{level, level, level, 255}));
        }
    }};
    std::thread server_thread{[&] {
        // On one core the client may not run at all for a while.
        while (server.records().size() < kRefreshes || server.frames_shown() < 10) {
            server.show_next();
            std::this_thread::yield();
        }
    }};
    server_thread.join();
    client_may_stop = true;
    client.join();

    EXPECT_EQ(watch.torn_frames.load(), 0);
    const auto& records = server.records();
    for (std::size_t i = 1; i < records.size(); ++i) EXPECT_GE(records[i].frame_index, records[i - 1].frame_index);
}

TEST(ServerLoopThreads, AnotherThreadStopsIt) {
    test::SimulatedClock clock;
    FrameExchange exchange;
    const test::FormulaHeadFeed head{[](TimePoint) { return Pose{}; }};
    const test::StillMovers movers{0};
    test::NewestSample predictor;
    FrameWarper warper{std::make_unique<TearingWatch>(clock), std::make_unique<test::NoFill>()};
    VirtualDisplay display{TimePoint{}, 90.0, {4, 4}};
    ServerSettings settings;
    settings.camera.size_px = {4, 4};
    ServerLoop server{ServerParts{clock, exchange, head, movers, predictor, warper, display}, settings};
    std::thread server_thread{[&] { server.run(); }};
    server.request_stop();
    server_thread.join();  // or the test runs into its time limit
}

}  // namespace
}  // namespace lw
