#pragma once
/// One trace through one scene on the virtual clock: every display frame of every method beside the truth.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/image_errors.h"
#include "apps/options.h"
#include "apps/replay_clock.h"
#include "apps/replay_truth.h"
#include "apps/scene_stage.h"
#include "client_renderer/source_camera.h"
#include "core/result.h"
#include "frame_link/prediction.h"
#include "frame_link/trace.h"
#include "warp_server/frame_warper.h"

namespace lw {

/// What one refresh shows, in the order of ReplayRun::labels().
struct RefreshPictures {
    ColourImage truth;
    std::vector<ColourImage> shown;
    std::vector<double> hole_fraction;  ///< before fill
};

struct RefreshRecord {
    std::uint64_t refresh = 0;  ///< number on the display's clock
    std::uint64_t frame = 0;    ///< client frame shown, from 0
    double latched_s = 0.0;
    double scanout_begin_s = 0.0;
    double photon_s = 0.0;
    double pose_sampled_s = 0.0;      ///< stamp of the pose the client frame was predicted from
    AttributedError cause_shares;     ///< share of the pixels whose error has each cause, for a warp of this frame
    std::vector<ImageErrors> errors;  ///< in the order of ReplayRun::labels()

    [[nodiscard]] double frame_age_ms() const { return (photon_s - pose_sampled_s) * 1e3; }
};

/// Wall times; what differs between two equal runs.
struct ReplayCosts {
    std::vector<double> app_ms;                   ///< per client frame: drawing it
    std::vector<std::vector<double>> prepare_ms;  ///< per method and client frame; empty for `fresh`
    std::vector<std::vector<double>> warp_ms;     ///< per method and refresh, fill included; empty for `fresh`
};

/// Draws each client frame and each truth once. All GL work happens on the thread that made the stage; error figures
/// are computed on up to options.threads threads.
class ReplayRun {
public:
    /// `stage` outlives the run. Replay's defaults for what `options` leaves open: 10 Hz, a latency of one client
    /// period, the oracle as predictor.
    [[nodiscard]] static Result<ReplayRun> create(const Options& options, const Trace& trace, const SceneStage& stage);

    /// --method, then the baselines in the order given.
    [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }
    [[nodiscard]] std::uint64_t first_refresh() const { return clock_.first_refresh(); }
    [[nodiscard]] std::uint64_t refresh_count() const { return refresh_count_; }
    [[nodiscard]] double pixels_per_degree() const;

    /// Draws and warps everything for one refresh. Refreshes may be asked for in any order; in ascending order each
    /// client frame is drawn once. The result is valid until the next call.
    const RefreshPictures& draw(std::uint64_t refresh);

    /// Errors of the pictures of the last draw(); their flicker where the draw() before was of the refresh before.
    [[nodiscard]] RefreshRecord judge() const;

    [[nodiscard]] const ReplayCosts& costs() const { return costs_; }
    /// Of every client frame drawn.
    [[nodiscard]] const std::vector<DrawCounters>& client_draws() const { return client_draws_; }
    /// Pixels of the client's frames so far over those of the display, mean over the frames.
    [[nodiscard]] double source_pixels_ratio() const;
    [[nodiscard]] std::uint64_t bad_depth_count() const { return bad_depth_count_; }

private:
    ReplayRun(const Options& options, const ReplayTiming& timing, TraceFeed feed, const SceneStage& stage);
    Status make_methods();
    void draw_client_frame(std::uint64_t frame);
    /// Runs every method's prepare step on layers that were just drawn.
    void prepare(std::span<const std::shared_ptr<Layer>> layers);
    [[nodiscard]] const Camera& source_camera_of(std::uint64_t frame);
    void show(std::size_t method, const WarpTarget& target, const Camera& true_camera, double photon_s);
    [[nodiscard]] std::optional<double> flicker_of(std::size_t method, const Image<int>& pixels_before) const;

    Options options_;
    ReplayClock clock_;
    TraceFeed feed_;
    SceneRenderer* renderer_;
    std::uint64_t refresh_count_ = 0;
    std::vector<std::string> labels_;
    std::vector<std::optional<FrameWarper>> warpers_;  ///< per label; nothing for `fresh`
    SourceCameras source_cameras_;
    std::vector<Camera> source_views_;  ///< of every client frame so far: each depends on those before it
    std::unique_ptr<HeadPosePredictor> client_predictor_;
    std::unique_ptr<HeadPosePredictor> server_predictor_;

    std::optional<std::uint64_t> drawn_frame_;  ///< number of the client frame that frame_ holds
    RenderedFrame frame_;
    CpuPixels fresh_pixels_;
    RefreshPictures pictures_;
    ReplayTruth truth_;
    RefreshRecord record_;
    bool has_before_ = false;  ///< the draw() before was of the refresh before; what it showed:
    RefreshPictures pictures_before_;
    ReplayTruth truth_before_;
    ReplayCosts costs_;
    std::vector<DrawCounters> client_draws_;
    std::uint64_t bad_depth_count_ = 0;
};

}  // namespace lw
