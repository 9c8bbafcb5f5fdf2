#include "frame_link/frame_exchange.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace lw {
namespace {

/// Frames whose every pixel says which frame it belongs to, and which note on what thread they died.
class StubClient {
public:
    explicit StubClient(std::thread::id home) : home_{home} {}

    [[nodiscard]] std::shared_ptr<const RenderedFrame> frame(std::uint64_t index) {
        auto layer = std::make_shared<Layer>();
        const auto mark = static_cast<std::uint16_t>(index & 0xFFFF);
        layer->camera.size_px = kSize_px;
        layer->scene_time_s = static_cast<double>(index);
        layer->pixels = CpuPixels{ColourImage{kSize_px, Rgba8{static_cast<std::uint8_t>(index & 0xFF), 0, 0, 255}},
                                  DepthImage{kSize_px, static_cast<float>(mark)}, ObjectIdImage{kSize_px, mark}};
        alive_.fetch_add(1);
        auto* frame = new RenderedFrame{index, {std::move(layer)}, {}};
        return {frame, [this](const RenderedFrame* dying) {
                    if (std::this_thread::get_id() != home_) foreign_deaths_.fetch_add(1);
                    alive_.fetch_sub(1);
                    delete dying;
                }};
    }

    [[nodiscard]] int alive() const { return alive_.load(); }
    [[nodiscard]] int foreign_deaths() const { return foreign_deaths_.load(); }

    static constexpr glm::ivec2 kSize_px{64, 16};

private:
    std::thread::id home_;
    std::atomic<int> alive_{0};
    std::atomic<int> foreign_deaths_{0};
};

bool is_whole(const RenderedFrame& frame) {
    const Layer& layer = *frame.layers.front();
    const auto mark = static_cast<std::uint16_t>(frame.index & 0xFFFF);
    for (const ObjectId id : layer.cpu().object_id.pixels()) {
        if (id != mark) return false;
    }
    for (const float depth : layer.cpu().depth.pixels()) {
        if (depth != static_cast<float>(mark)) return false;
    }
    for (const Rgba8 colour : layer.cpu().colour.pixels()) {
        if (colour.r != (frame.index & 0xFF)) return false;
    }
    return layer.scene_time_s == static_cast<double>(frame.index);
}

TEST(FrameExchange, IsEmptyBeforeTheFirstFrame) {
    FrameExchange exchange;
    EXPECT_EQ(exchange.latest(), nullptr);
    EXPECT_EQ(exchange.latest(), nullptr);
    EXPECT_EQ(exchange.taken_count(), 0U);
}

TEST(FrameExchange, HandsOutTheNewestAndKeepsIt) {
    StubClient client{std::this_thread::get_id()};
    FrameExchange exchange;
    exchange.publish(client.frame(1));
    const RenderedFrame* first = exchange.latest();
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first->index, 1U);
    EXPECT_EQ(exchange.latest(), first);

    for (std::uint64_t index = 2; index <= 5; ++index) exchange.publish(client.frame(index));
    EXPECT_EQ(first->index, 1U) << "a frame stays valid until the consumer asks again";
    EXPECT_EQ(exchange.latest()->index, 5U);
    EXPECT_EQ(exchange.published_count(), 5U);
    EXPECT_EQ(exchange.taken_count(), 2U);
}

TEST(FrameExchange, HoldsAtMostThreeFrames) {
    StubClient client{std::this_thread::get_id()};
    FrameExchange exchange;
    for (std::uint64_t index = 1; index <= 50; ++index) {
        exchange.publish(client.frame(index));
        EXPECT_LE(client.alive(), 3);
        if (index % 3 == 0) {
            EXPECT_EQ(exchange.latest()->index, index);
        }
    }
}

TEST(FrameExchange, DropsEverythingOnRequestAndCanGoOn) {
    StubClient client{std::this_thread::get_id()};
    FrameExchange exchange;
    exchange.publish(client.frame(1));
    EXPECT_NE(exchange.latest(), nullptr);
    exchange.publish(client.frame(2));
    exchange.drop_all();
    EXPECT_EQ(client.alive(), 0);
    EXPECT_EQ(exchange.latest(), nullptr);
    exchange.publish(client.frame(3));
    EXPECT_EQ(exchange.latest()->index, 3U);
}

TEST(FrameExchange, DestructionDropsTheRest) {
    StubClient client{std::this_thread::get_id()};
    {
        FrameExchange exchange;
        exchange.publish(client.frame(1));
        exchange.publish(client.frame(2));
    }
    EXPECT_EQ(client.alive(), 0);
}

TEST(FrameExchangeDeathTest, RefusesNull) {
    FrameExchange exchange;
    EXPECT_DEATH(exchange.publish(nullptr), "not null");
}

// Both sides race without any pause. The consumer goes on until it has seen the last frame, so each side keeps running
// into the other whatever the scheduler does.
TEST(FrameExchange, NeverTearsNeverGoesBackAndFramesDieAtHome) {
    constexpr std::uint64_t kFrames = 20000;
    StubClient client{std::this_thread::get_id()};
    FrameExchange exchange;
    std::uint64_t torn = 0;
    std::uint64_t backward = 0;
    std::uint64_t distinct = 0;

    std::thread server{[&] {
        std::uint64_t newest = 0;
        while (newest < kFrames) {
            const RenderedFrame* frame = exchange.latest();
            if (frame == nullptr) continue;
            if (!is_whole(*frame)) ++torn;
            if (frame->index < newest) ++backward;
            if (frame->index > newest) ++distinct;
            newest = frame->index;
        }
    }};
    for (std::uint64_t index = 1; index <= kFrames; ++index) exchange.publish(client.frame(index));
    server.join();
    exchange.drop_all();

    EXPECT_EQ(torn, 0U);
    EXPECT_EQ(backward, 0U);
    EXPECT_EQ(exchange.taken_count(), distinct);
    EXPECT_EQ(exchange.published_count(), kFrames);
    EXPECT_EQ(client.foreign_deaths(), 0);
    EXPECT_EQ(client.alive(), 0);
}

}  // namespace
}  // namespace lw
