#pragma once
/// The client's thread: sample the head, predict, draw, prepare, publish; as fast as it can or at a given rate.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client_renderer/layer_pool.h"
#include "client_renderer/scene_renderer.h"
#include "client_renderer/shell_client.h"
#include "client_renderer/source_camera.h"
#include "core/clock.h"
#include "frame_link/drawn_view.h"
#include "frame_link/frame_exchange.h"
#include "frame_link/prediction.h"

namespace lw {

struct ClientSettings {
    Camera camera;                 ///< the display's size, field of view and near plane; its pose is ignored
    std::vector<DrawnView> views;  ///< what is drawn for two eyes; empty: one view of `camera`
    SourceSettings source;         ///< what is drawn for it
    ShellSettings shells;          ///< on: one view's frames consist of shells; one with nothing new is not published
    HoleFeedbackLink* feedback = nullptr;  ///< where the server reports holes; null: it does not. Outlives the loop
    std::optional<double> reveal_margin_m = 0.0;  ///< --reveal-margin, metres; nothing: as the head moves
    double min_pixels = 0.0;                      ///< --min-pixels, to tell the renderer whether the viewer moves
    double max_hz = 0.0;                          ///< 0: as fast as it can
    bool predict_source_pose =
        true;               ///< draw for the middle of the frame's life on the display (--source-pose predicted)
    bool textures = false;  ///< hand frames over as textures (a GPU with shared contexts), else as CPU memory: for one
                            ///< layer only
};

/// What runs before a layer is published: the warp method's prepare step, handed in by apps.
using PrepareLayer = std::function<void(Layer&)>;

/// One published frame as the client saw it.
struct ClientFrameRecord {
    std::uint64_t index = 0;
    RenderTimes times;
    DrawCounters counters;
    Camera view;                ///< of its first layer
    double scene_time_s = 0.0;  ///< of its first layer
};

/// Runs on the thread that calls run(), with the renderer's context current there.
///
/// A frame published at P and replaced one frame period later is on the display from P to P + period; its middle is
/// what the client draws for: time of sampling + latency from sampling to publishing + half a period. Latency and
/// period are those of the past frames, smoothed; before the first frame they count as zero.
class ClientLoop {
public:
    /// References outlive the loop. Scene time is seconds of the clock. `prepare` may be empty.
    ClientLoop(SceneRenderer& renderer, Clock& clock, const HeadPoseFeed& head, FrameExchange& exchange,
               std::unique_ptr<HeadPosePredictor> predictor, PrepareLayer prepare, ClientSettings settings);

    /// Draws and publishes until request_stop(), at most max_hz times a second. A renderer that throws ends it: what
    /// was published stays, and failure() says why.
    void run();
    /// One frame: what run() repeats.
    void draw_and_publish();

    /// Any thread: at most so many frames per second from the next one on, 0 for as fast as it can.
    void set_max_hz(double hz) { max_hz_.store(hz, std::memory_order_relaxed); }
    /// Any thread: no new frames until it is set back; the newest one stays.
    void set_frozen(bool frozen) { frozen_.store(frozen, std::memory_order_relaxed); }

    /// Any thread. The frame under way is still published.
    void request_stop() { stop_.store(true, std::memory_order_relaxed); }

    /// What a renderer threw, empty if none did. After run() has returned.
    [[nodiscard]] const std::string& failure() const { return failure_; }

    /// Every published frame. After run() has returned.
    [[nodiscard]] const std::vector<ClientFrameRecord>& records() const { return records_; }
    /// Of every turn of the loop, drawn or not; empty without shells. After run() has returned.
    [[nodiscard]] const std::vector<ShellFrameRecord>& shell_records() const;

private:
    struct View {
        DrawnView drawn;
        SourceCameras cameras;
    };
    /// What all views of one frame have in common.
    struct FrameTimes {
        TimePoint sampled;
        TimePoint target;  ///< what it is drawn for
        PredictedPose head;
    };

    void draw_until_stopped();
    void draw_view(View& view, const FrameTimes& times, std::vector<std::shared_ptr<Layer>>& layers);
    void draw_hidden(const View& view, const FrameTimes& times, std::vector<std::shared_ptr<Layer>>& layers);
    [[nodiscard]] double eye_motion_m(const View& view, const FrameTimes& times);
    void draw_and_publish_shells();
    [[nodiscard]] TimePoint middle_of_display_life(TimePoint sampled) const;
    void learn_timing(TimePoint sampled, TimePoint published);

    SceneRenderer& renderer_;
    Clock& clock_;
    const HeadPoseFeed& head_;
    FrameExchange& exchange_;
    std::unique_ptr<HeadPosePredictor> predictor_;
    PrepareLayer prepare_;
    ClientSettings settings_;
    std::vector<View> views_;
    LayerPool layers_;
    std::unique_ptr<ShellClient> shells_;
    std::atomic<bool> stop_{false};
    std::atomic<bool> frozen_{false};
    std::atomic<double> max_hz_;
    std::vector<ClientFrameRecord> records_;
    std::string failure_;
    Duration latency_{};  ///< smoothed time from sampling to publishing
    Duration period_{};   ///< smoothed time between publications
};

}  // namespace lw
