#pragma once
/// One trace through one scene on the virtual clock: every display frame of every method beside the truth, for one eye
/// or two.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/image_errors.h"
#include "apps/options.h"
#include "apps/replay_client.h"
#include "apps/replay_clock.h"
#include "apps/replay_method.h"
#include "apps/replay_truth.h"
#include "apps/scene_stage.h"
#include "core/eye_consistency.h"
#include "core/result.h"
#include "frame_link/prediction.h"
#include "frame_link/trace.h"

namespace lw {

/// What one eye sees at one refresh, in the order of ReplayRun::labels().
struct RefreshPictures {
    ColourImage truth;
    std::vector<ColourImage> shown;
    std::vector<double> hole_fraction;          ///< before fill
    std::vector<double> behind_fraction;        ///< reached, by something behind what should be seen there
    std::vector<Image<std::uint8_t>> invented;  ///< 1 where the fill made a pixel up; empty with one eye
};

/// One eye's figures of a refresh.
struct EyeRecord {
    AttributedError cause_shares;     ///< share of the pixels whose error has each cause, for a warp of this frame
    std::vector<ImageErrors> errors;  ///< in the order of ReplayRun::labels()
};

struct RefreshRecord {
    std::uint64_t refresh = 0;  ///< number on the display's clock
    std::uint64_t frame = 0;    ///< client frame shown, from 0
    double latched_s = 0.0;
    double scanout_begin_s = 0.0;
    double photon_s = 0.0;
    double pose_sampled_s = 0.0;  ///< stamp of the pose the client frame was predicted from
    std::vector<EyeRecord> eyes;  ///< one, or left and right
    /// In the order of ReplayRun::labels(); nothing where the eyes see nothing in common, empty with one eye.
    std::vector<std::optional<EyeConsistency>> consistency;

    [[nodiscard]] double frame_age_ms() const { return (photon_s - pose_sampled_s) * 1e3; }
};

/// Wall and processor times; what differs between two equal runs.
struct ReplayCosts {
    std::vector<std::vector<double>> app_ms;      ///< per method and client frame: drawing what it needs, every view
    std::vector<double> app_model_ms;             ///< of --method, modelled (shell_budget.h): equal in equal runs
    std::vector<double> main_view_ms;             ///< of --method with shells: drawing everything as one layer
    std::vector<std::vector<double>> prepare_ms;  ///< per method and client frame; empty for `fresh`
    std::vector<std::vector<double>> warp_ms;  ///< per method and refresh, fill included, all eyes; empty for `fresh`
    std::vector<std::vector<double>> warp_cpu_ms;  ///< the same as processor time of all threads
};

/// Draws each client frame and each truth once. All GL work happens on the thread that made the stage; error figures
/// are computed on up to options.threads threads.
class ReplayRun {
public:
    /// `stage` outlives the run. Replay's defaults for what `options` leaves open: 10 Hz, a latency of one client
    /// period, the oracle as predictor.
    [[nodiscard]] static Result<ReplayRun> create(const Options& options, const Trace& trace, const SceneStage& stage);

    /// --method (with --stereo scanline that), then the baselines in the order given.
    [[nodiscard]] const std::vector<std::string>& labels() const { return labels_; }
    [[nodiscard]] std::size_t eye_count() const { return eyes_.size(); }
    [[nodiscard]] std::uint64_t first_refresh() const { return clock_.first_refresh(); }
    [[nodiscard]] std::uint64_t refresh_count() const { return refresh_count_; }
    [[nodiscard]] double pixels_per_degree() const;

    /// Draws and warps everything for one refresh. Refreshes may be asked for in any order; in ascending order each
    /// client frame is drawn once. The pictures are then those of pictures(); valid until the next call.
    void draw(std::uint64_t refresh);
    [[nodiscard]] const RefreshPictures& pictures(std::size_t eye) const { return eyes_[eye].pictures; }

    /// Errors of the pictures of the last draw(); their flicker where the draw() before was of the refresh before.
    [[nodiscard]] RefreshRecord judge() const;

    [[nodiscard]] ReplayCosts costs() const;
    /// Of every view of every client frame drawn for --method.
    [[nodiscard]] const std::vector<DrawCounters>& client_draws() const { return client_of(0).counters(); }
    /// Pixels of the frames drawn for --method so far over those of one eye's picture, mean over the frames.
    [[nodiscard]] double source_pixels_ratio() const { return client_of(0).source_pixels_ratio(options_.size_px); }
    [[nodiscard]] std::uint64_t bad_depth_count() const { return bad_depth_count_; }
    /// Null without shells; its records are by client frame.
    [[nodiscard]] const ReplayShells* shells() const { return client_of(0).shells(); }

private:
    /// What one eye sees, now and at the draw() before.
    struct ReplayEye {
        EyeView view;
        RefreshPictures pictures;
        RefreshPictures pictures_before;
        ReplayTruth truth;
        ReplayTruth truth_before;
    };

    ReplayRun(const Options& options, const ReplayTiming& timing, TraceFeed feed, const SceneStage& stage);
    void make_eyes(const Trace& trace);
    Status make_methods(const Trace& trace);
    Status find_client(std::size_t method, const Trace& trace);
    [[nodiscard]] const ReplayClient& client_of(std::size_t method) const { return clients_[client_index_[method]]; }
    void draw_client_frames(std::uint64_t frame);
    /// Runs the prepare step of every method that is shown from the client, on layers that were just drawn.
    void prepare(std::size_t client, std::span<const std::shared_ptr<Layer>> layers);
    [[nodiscard]] Camera camera_at(const ReplayEye& eye, const Pose& world_from_head) const;
    void draw_truth(ReplayEye& eye, const Pose& world_from_head, double photon_s);
    void show(std::size_t method, const Pose& predicted_head, const Pose& true_head, double photon_s);
    void show_fresh(std::size_t method, const Pose& true_head, double photon_s);
    [[nodiscard]] EyeRecord judge_eye(std::size_t eye) const;
    [[nodiscard]] std::optional<EyeConsistency> consistency_of(std::size_t method) const;

    Options options_;
    ReplayClock clock_;
    TraceFeed feed_;
    SceneRenderer* renderer_;
    std::uint64_t refresh_count_ = 0;
    std::optional<StereoRig> rig_;
    std::vector<ReplayEye> eyes_;  ///< one, or left and right
    std::vector<std::string> labels_;
    std::vector<ReplayMethod> methods_;  ///< per label
    std::vector<ReplayClient> clients_;  ///< one for each way of drawing that a method needs
    std::vector<std::optional<StereoMode>> client_modes_;
    std::vector<std::size_t> client_index_;  ///< per label
    std::unique_ptr<HeadPosePredictor> client_predictor_;
    std::unique_ptr<HeadPosePredictor> server_predictor_;

    CpuPixels fresh_pixels_;
    RefreshRecord record_;
    bool has_before_ = false;  ///< the draw() before was of the refresh before
    ReplayCosts costs_;
    std::uint64_t bad_depth_count_ = 0;
    TimePoint shown_at_;  ///< scan-out of the refresh being drawn
};

}  // namespace lw
