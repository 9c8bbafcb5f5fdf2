#pragma once
/// A machine in a test: a clock that wakes late when told to, and a warp method that takes as long as it is told to.

#include <functional>
#include <memory>
#include <string>

#include "core/clock.h"
#include "frame_link/feeds.h"
#include "frame_link/prediction.h"
#include "warp_server/fill.h"
#include "warp_server/warp_method.h"

namespace lw::test {

/// Waiting advances it, and may wake late.
class SimulatedClock final : public Clock {
public:
    [[nodiscard]] TimePoint now() const override { return now_; }
    void sleep_until(TimePoint wake) override {
        if (wake > now_) now_ = wake;
        if (lateness) now_ += lateness();
    }
    void advance(Duration step) { now_ += step; }

    std::function<Duration()> lateness;

private:
    TimePoint now_{};
};

/// Copies the first layer's colour to the target and lets `work()` pass.
class TimedMethod final : public WarpMethod {
public:
    TimedMethod(SimulatedClock& clock, std::function<Duration()> work) : clock_{clock}, work_{std::move(work)} {}
    [[nodiscard]] std::string_view label() const override { return "timed"; }
    void warp(const Layer& layer, const WarpTarget& target, DisplayFrame& out) override {
        out.resize(target.camera.size_px);
        for (Rgba8& pixel : out.colour.pixels()) pixel = layer.cpu().colour.at(0, 0);
        for (Coverage& coverage : out.coverage.pixels()) coverage = Coverage::reached;
        last_target = target.camera;
        last_mover_count = target.movers.size();
        clock_.advance(work_());
    }

    Camera last_target;
    std::size_t last_mover_count = 0;

private:
    SimulatedClock& clock_;
    std::function<Duration()> work_;
};

/// Leaves the picture alone.
class NoFill final : public Fill {
public:
    [[nodiscard]] std::string_view name() const override { return "nothing"; }
    void apply(DisplayFrame& frame, const FillGuide& /*guide*/) override { (void)frame; }
};

/// A tracker with a sample every millisecond, at `pose(time)`.
class FormulaHeadFeed final : public HeadPoseFeed {
public:
    explicit FormulaHeadFeed(std::function<Pose(TimePoint)> pose) : pose_{std::move(pose)} {}
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        auto number = now.time_since_epoch() / std::chrono::milliseconds{1};
        for (PoseSample& sample : samples) {
            sample.time = TimePoint{std::chrono::milliseconds{number}};
            sample.world_from_head = pose_(sample.time);
            sample.number = static_cast<std::uint64_t>(number--);
        }
        return samples.size();
    }

private:
    std::function<Pose(TimePoint)> pose_;
};

/// `count` movers that stand still.
class StillMovers final : public ObjectTransformFeed {
public:
    explicit StillMovers(ObjectId count) : count_{count} {}
    void placements_at(TimePoint time, std::vector<ObjectTransform>& transforms) const override {
        (void)time;
        transforms.clear();
        for (ObjectId id = 1; id <= count_; ++id) transforms.push_back({id, glm::dmat4{1.0}});
    }

private:
    ObjectId count_;
};

/// Shows the newest sample as it is.
class NewestSample final : public HeadPosePredictor {
public:
    [[nodiscard]] PredictedPose predict(const HeadPoseFeed& feed, TimePoint now, TimePoint target) override {
        (void)target;
        PoseSample sample;
        if (feed.newest(now, {&sample, 1}) == 0) return {};
        return {sample.world_from_head, sample.time, sample.number};
    }
};

/// A one-layer frame of one colour.
inline std::shared_ptr<const RenderedFrame> plain_frame(std::uint64_t index, TimePoint pose_sampled, Rgba8 colour) {
    auto layer = std::make_shared<Layer>();
    layer->camera.size_px = {4, 4};
    layer->pose_sampled = pose_sampled;
    layer->pixels = CpuPixels{ColourImage{{4, 4}, colour}, DepthImage{{4, 4}}, ObjectIdImage{{4, 4}}};
    auto frame = std::make_shared<RenderedFrame>();
    frame->index = index;
    frame->layers = {layer};
    return frame;
}

}  // namespace lw::test
