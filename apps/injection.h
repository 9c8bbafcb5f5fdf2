#pragma once
/// Known delays put into a live run, by turns, so that the latency harness can prove itself by finding them.

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "apps/options.h"
#include "frame_link/feeds.h"
#include "frame_link/frame_exchange.h"

namespace lw {

/// What is delayed during a segment.
enum class Injected : std::uint8_t { nothing, tracker, app, present };

/// Time is cut into segments of kSegment from `start` on: nothing, then each injected delay by itself, and again.
/// Immutable; any thread.
class InjectionPlan {
public:
    /// Nothing is ever injected.
    InjectionPlan() = default;
    InjectionPlan(const InjectedDelays& delays, TimePoint start);

    [[nodiscard]] bool any() const { return turns_.size() > 1; }
    [[nodiscard]] Injected at(TimePoint time) const;
    /// The segment at `time` if it began at least kSettling ago: what was under way when it began has passed.
    [[nodiscard]] std::optional<Injected> settled_at(TimePoint time) const;
    /// The delay of `what` at `time`, zero outside its segments.
    [[nodiscard]] Duration delay(Injected what, TimePoint time) const {
        return at(time) == what ? size_of(what) : Duration::zero();
    }
    [[nodiscard]] Duration size_of(Injected what) const;

    static constexpr Duration kSegment = std::chrono::milliseconds{1500};
    static constexpr Duration kSettling = std::chrono::milliseconds{400};

private:
    InjectedDelays delays_;
    TimePoint start_;
    std::vector<Injected> turns_{Injected::nothing};
};

/// A tracker whose samples arrive late during its segments; their stamps stay.
class DelayedHeadFeed final : public HeadPoseFeed {
public:
    DelayedHeadFeed(const HeadPoseFeed& feed, const InjectionPlan& plan) : feed_{feed}, plan_{plan} {}
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        return feed_.newest(now - plan_.delay(Injected::tracker, now), samples);
    }

private:
    const HeadPoseFeed& feed_;
    const InjectionPlan& plan_;
};

/// Takes the frames that the client publishes and publishes them again, late during the app's segments: the client
/// draws at its own rate all the while. A thread of its own; CPU frames only, since frames die on it.
class FrameDelayLine {
public:
    /// `in`: this is its consumer, `out`: this is its producer. All outlive the line; the thread runs until stop().
    FrameDelayLine(Clock& clock, FrameExchange& in, FrameExchange& out, const InjectionPlan& plan);
    ~FrameDelayLine();
    void stop();

private:
    void run();

    Clock& clock_;
    FrameExchange& in_;
    FrameExchange& out_;
    const InjectionPlan& plan_;
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace lw
