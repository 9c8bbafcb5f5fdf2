#pragma once
/// The client's thread of a live run: the renderer and its loop.

#include <atomic>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "apps/live_run.h"
#include "apps/live_session.h"
#include "client_renderer/client_loop.h"
#include "client_renderer/scene_renderer.h"
#include "core/result.h"
#include "frame_link/drawn_view.h"
#include "frame_link/prediction.h"

namespace lw {

/// Everything but run_thread() is for the main thread.
class LiveClient {
public:
    /// `run` and `after` outlive this.
    LiveClient(LiveRun& run, std::unique_ptr<HeadPosePredictor> predictor, const AfterLiveRun& after)
        : run_{run}, predictor_{std::move(predictor)}, after_{after} {}

    /// The whole of its thread.
    void run_thread();

    [[nodiscard]] Status wait_until_ready() { return ready_.get_future().get(); }
    /// After run_thread(): what became of it.
    [[nodiscard]] Status outcome() { return done_.get_future().get(); }

    /// Before it draws and afterwards these do nothing.
    void set_frozen(bool frozen);
    void set_max_hz(double hz);
    /// After LiveRun::stop.
    void request_stop();

private:
    Status prepare();
    void warm_up();
    [[nodiscard]] ClientSettings settings() const;
    void draw_until_stopped();
    void take_results();

    LiveRun& run_;
    std::unique_ptr<HeadPosePredictor> predictor_;
    const AfterLiveRun& after_;
    std::unique_ptr<gl::Context> context_;
    std::unique_ptr<SceneRenderer> renderer_;
    std::vector<DrawnView> views_;
    std::optional<ClientLoop> loop_;
    std::atomic<ClientLoop*> running_{nullptr};  ///< the loop, which stays
    std::promise<Status> ready_;
    std::promise<Status> done_;
};

}  // namespace lw
