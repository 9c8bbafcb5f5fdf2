#pragma once
/// The server's thread of a live run: the warper, the display and the server's loop.

#include <atomic>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "apps/demo_overlay.h"
#include "apps/live_run.h"
#include "apps/window_presenter.h"
#include "core/result.h"
#include "frame_link/prediction.h"
#include "warp_server/server_loop.h"
#include "warp_server/virtual_display.h"

namespace lw {

/// Everything but run_thread() is for the main thread.
class LiveServer {
public:
    /// @param window   null: a virtual display; outlives this, like the others
    /// @param overlay  told of every refresh in a window
    LiveServer(LiveRun& run, WindowPresenter* window, DemoOverlay& overlay,
               std::unique_ptr<HeadPosePredictor> predictor);

    /// The whole of its thread, which begins when the client is ready.
    void run_thread();

    [[nodiscard]] Status wait_until_ready() { return ready_.get_future().get(); }

    /// Twice the strips, or one after the most. Pictures for two eyes are made whole.
    void show_in_next_strips();
    /// After LiveRun::stop.
    void request_stop();

private:
    Status prepare(std::unique_ptr<gl::Context>& context);
    void raise_priority();
    [[nodiscard]] int first_strips() const;
    [[nodiscard]] std::size_t reserved_parts() const;
    [[nodiscard]] bool has_photon_codes() const;
    [[nodiscard]] ServerSettings settings();
    void show_until_stopped();
    void make_loop(ServerSettings& settings, Presenter& presenter);
    [[nodiscard]] bool is_in_time(int strips);
    void watch_photons();
    void show(int strips);
    void take_loop_results(int strips);
    void take_display_results(const Camera& camera);

    LiveRun& run_;
    WindowPresenter* window_;
    DemoOverlay& overlay_;
    std::unique_ptr<HeadPosePredictor> predictor_;
    std::optional<VirtualDisplay> virtual_display_;
    std::mutex loop_mutex_;  ///< while there is another loop to stop
    std::optional<ServerLoop> loop_;
    std::atomic<bool> show_on_{false};  ///< the loop was stopped to go on with other strips
    std::promise<Status> ready_;
};

}  // namespace lw
