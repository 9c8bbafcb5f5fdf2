#pragma once
/// The client's thread: sample the head, predict, draw, prepare, publish; as fast as it can or at a given rate.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "client_renderer/scene_renderer.h"
#include "core/clock.h"
#include "frame_link/frame_exchange.h"
#include "frame_link/prediction.h"

namespace lw {

struct ClientSettings {
    Camera camera;        ///< size, field of view and near plane; its pose is ignored
    double max_hz = 0.0;  ///< 0: as fast as it can
    bool predict_source_pose =
        true;               ///< draw for the middle of the frame's life on the display (--source-pose predicted)
    bool textures = false;  ///< hand frames over as textures (a GPU with shared contexts), else as CPU memory
};

/// What runs before a layer is published: the warp method's prepare step, handed in by apps.
using PrepareLayer = std::function<void(Layer&)>;

/// One published frame as the client saw it.
struct ClientFrameRecord {
    std::uint64_t index = 0;
    RenderTimes times;
    DrawCounters counters;
};

/// Runs on the thread that calls run(), with the renderer's context current there.
class ClientLoop {
public:
    /// References outlive the loop. Scene time is seconds of the clock.
    ClientLoop(SceneRenderer& renderer, Clock& clock, const HeadPoseFeed& head, FrameExchange& exchange,
               std::unique_ptr<HeadPosePredictor> predictor, PrepareLayer prepare, ClientSettings settings);

    /// Draws and publishes until request_stop().
    void run();
    /// One frame: what run() repeats.
    void draw_and_publish();

    /// Any thread.
    void request_stop() { stop_.store(true, std::memory_order_relaxed); }

    /// After run() has returned.
    [[nodiscard]] const std::vector<ClientFrameRecord>& records() const { return records_; }

private:
    SceneRenderer& renderer_;
    Clock& clock_;
    const HeadPoseFeed& head_;
    FrameExchange& exchange_;
    std::unique_ptr<HeadPosePredictor> predictor_;
    PrepareLayer prepare_;
    ClientSettings settings_;
    std::atomic<bool> stop_{false};
    std::vector<ClientFrameRecord> records_;
    Duration frame_time_{};  ///< smoothed time from sampling to publishing
};

}  // namespace lw
