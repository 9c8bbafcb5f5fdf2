#pragma once
/// What the threads of a live run share: the main one moves head and objects and follows the keys, the client's draws,
/// the server's shows.

#include <atomic>
#include <future>
#include <memory>

#include "apps/demo_controls.h"
#include "apps/live_result.h"
#include "apps/live_warper.h"
#include "apps/options.h"
#include "apps/real_clock.h"
#include "core/result.h"
#include "frame_link/frame_exchange.h"
#include "frame_link/hole_feedback.h"
#include "frame_link/sampled_mover_feed.h"
#include "frame_link/trace.h"
#include "gl/context.h"
#include "scene/scene.h"
#include "warp_server/eye_layout.h"
#include "warp_server/methods/registry.h"

namespace lw {

/// Of the whole picture: of one eye, or of both beside each other.
[[nodiscard]] inline glm::ivec2 picture_size_px(const Options& options) {
    return options.stereo.on ? packed_size_px(options.stereo.layout, options.size_px) : options.size_px;
}

/// Made by the main thread, and there until the others have ended. They start after one another, and each tells when it
/// is ready: what is written before is read by the others after the run has been let go.
struct LiveRun {
    LiveRun(const Options& all_options, const scene::Scene& shown_scene, const Trace& head_trace)
        : options{all_options}, scene{shown_scene}, trace{head_trace}, entry{*find_warp_method(all_options.method)} {}

    // All threads, from the beginning.
    const Options& options;
    const scene::Scene& scene;
    const Trace& trace;
    const MethodEntry& entry;  ///< of options.method
    RealClock clock;
    DemoControls controls;  ///< only a window has keys for them
    bool realtime_allowed = false;
    std::atomic<bool> stop{false};

    // The client's thread, until it is ready.
    const gl::Context* client_context = nullptr;
    bool textures = false;  ///< frames are handed over in textures

    // The server's thread, until it is ready; the client prepares layers with it until client_stopped.
    LiveWarper warper;

    // The main thread, until the run is let go.
    const HeadPoseFeed* head = nullptr;
    std::shared_ptr<const TraceFeed> trace_feed;
    bool delays_frames = false;

    SampledMoverFeed movers;  ///< what the server is told of them
    HoleFeedbackLink hole_feedback;
    /// From which the server takes frames. Dropped by the client's thread, whose context its textures need.
    std::unique_ptr<FrameExchange> exchange = std::make_unique<FrameExchange>();
    std::unique_ptr<FrameExchange> before_delay = std::make_unique<FrameExchange>();
    [[nodiscard]] FrameExchange& client_exchange() { return delays_frames ? *before_delay : *exchange; }

    LiveResult result;  ///< each part by one thread; the client's reads all of it in the end

    // Phases.
    std::promise<bool> go;  ///< false: the other side could not start
    std::shared_future<bool> may_go{go.get_future()};
    std::promise<void> client_stopped;
    std::future<void> may_drop_warper{client_stopped.get_future()};
    std::promise<void> server_ended;
    std::future<void> may_drop_frames{server_ended.get_future()};
};

}  // namespace lw
