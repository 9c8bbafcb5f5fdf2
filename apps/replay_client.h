#pragma once
/// The client of a replay: draws the views of each of its frames at the times of the virtual clock.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "apps/options.h"
#include "apps/replay_clock.h"
#include "apps/replay_shells.h"
#include "client_renderer/scene_renderer.h"
#include "client_renderer/source_camera.h"
#include "frame_link/drawn_view.h"
#include "frame_link/prediction.h"
#include "frame_link/rendered_frame.h"

namespace lw {

/// Where a replay's poses come from, and who predicts for the client.
struct ReplayHead {
    const ReplayClock& clock;
    const HeadPoseFeed& feed;
    HeadPosePredictor& client_predictor;
};

/// One way of drawing frames; two eyes may be drawn in several. One thread, the renderer's.
class ReplayClient {
public:
    ReplayClient(const Options& options, std::vector<DrawnView> views);
    ReplayClient(const ReplayClient&) = delete;
    ReplayClient& operator=(const ReplayClient&) = delete;
    ReplayClient(ReplayClient&&) = default;
    ReplayClient& operator=(ReplayClient&&) = default;
    ~ReplayClient() = default;

    /// Makes frame() that of number `frame`, unless it is. Each of its views is drawn once, from one predicted head
    /// pose. `prepare` gets the layers of all of them.
    void draw(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer,
              const std::function<void(std::span<const std::shared_ptr<Layer>>)>& prepare);

    /// Whether it hears of holes.
    [[nodiscard]] bool draws_shells() const { return options_.shells.on; }
    /// With shells: the server showed frame() with these holes. The client hears of them when it begins its next frame
    /// after `feedback.shown`.
    void report(HoleFeedback feedback);

    /// The frame drawn last; it has a layer for each view, with hidden layers two.
    [[nodiscard]] const RenderedFrame& frame() const { return frame_; }
    /// The layer that `eye` is shown from before what is hidden in it.
    [[nodiscard]] const Layer& layer_for(Eye eye) const;

    [[nodiscard]] const std::vector<double>& draw_ms() const { return draw_ms_; }  ///< per frame, all of its views
    [[nodiscard]] const std::vector<DrawCounters>& counters() const { return counters_; }  ///< per frame and view
    /// The same modelled (client_renderer/shell_budget.h): equal in equal runs.
    [[nodiscard]] const std::vector<double>& model_ms() const { return model_ms_; }
    /// With shells, per frame: drawing everything as one layer would take so long.
    [[nodiscard]] const std::vector<double>& main_view_ms() const { return main_view_ms_; }
    /// Null without shells, and before the first frame.
    [[nodiscard]] const ReplayShells* shells() const { return shells_.get(); }
    /// Pixels of all views of a frame over `display_px`, mean over the frames.
    [[nodiscard]] double source_pixels_ratio(glm::ivec2 display_px) const;

private:
    struct View {
        DrawnView drawn;
        SourceCameras cameras;
        std::vector<Camera> of_frames;  ///< of every frame so far: each depends on those before it
    };

    [[nodiscard]] const Camera& camera_of(View& view, std::uint64_t frame, const ReplayHead& head);
    void draw_view(View& view, std::uint64_t frame, const PredictedPose& pose, const ReplayHead& head,
                   SceneRenderer& renderer, std::vector<std::shared_ptr<Layer>>& layers);
    void draw_shells(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer);
    [[nodiscard]] ShellMoment moment_of(std::uint64_t frame, const ReplayHead& head);
    void learn_main_view(std::uint64_t frame, const ReplayHead& head, SceneRenderer& renderer);
    [[nodiscard]] double modelled_ms(const SceneRenderer& renderer, const Layer& layer) const;
    [[nodiscard]] TimePoint drawn_for(std::uint64_t frame, const ReplayHead& head) const;

    Options options_;
    std::vector<View> views_;
    std::optional<std::uint64_t> drawn_frame_;  ///< number of the frame that frame_ holds
    RenderedFrame frame_;
    std::vector<double> draw_ms_;
    std::vector<double> model_ms_;
    std::vector<double> main_view_ms_;
    std::vector<double> main_view_model_ms_;
    std::unique_ptr<ReplayShells> shells_;
    std::vector<DrawCounters> counters_;
};

}  // namespace lw
