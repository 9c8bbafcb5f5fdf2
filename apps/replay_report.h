#pragma once
/// The reports of a replay: JSON (latewarp.replay/1), CSV with one row per display frame, and an HTML page.

#include <optional>
#include <string>
#include <vector>

#include "apps/html_report.h"
#include "apps/image_errors.h"
#include "apps/replay_run.h"
#include "apps/report.h"
#include "core/statistics.h"

namespace lw {

struct ReplayResult {
    std::vector<std::string> labels;  ///< --method, then the baselines
    std::vector<RefreshRecord> refreshes;
    ReplayCosts costs;
    std::vector<DrawCounters> client_draws;  ///< of every view of every client frame
    std::vector<ShellFrameRecord> shells;    ///< by client frame; empty without shells
    double pixels_per_degree = 0.0;
    double source_pixels_ratio = 1.0;    ///< pixels of the client's frames over those of one eye's picture, mean
    std::uint64_t bad_depth_pixels = 0;  ///< of --method, over all refreshes
};

/// The figures of one method over a run; two eyes' are pooled.
struct ErrorSummary {
    std::optional<Distribution> flip;
    std::optional<Distribution> ssim;
    std::optional<Distribution> psnr_db;  ///< over the frames that differ from the truth
    std::optional<Distribution> hole_fraction;
    std::optional<Distribution> behind_fraction;
    std::optional<Distribution> flicker;       ///< over the frames that have one before them
    std::optional<Distribution> ssim_to_same;  ///< against `fresh-same`, where that is a baseline
    struct Parts {
        std::optional<Distribution> resampled;
        std::optional<Distribution> disoccluded;
        std::optional<Distribution> out_of_frame;
        std::optional<Distribution> stale_shading;
    };
    Parts attribution;               ///< of FLIP
    std::uint64_t equal_frames = 0;  ///< pictures equal to the truth, which have no PSNR
};

/// `method` indexes result.labels. Pure.
/// @param eye  of that eye alone, 0 or 1; nothing: of all
[[nodiscard]] ErrorSummary summary_of(const ReplayResult& result, std::size_t method,
                                      std::optional<std::size_t> eye = {});

/// How well two eyes agree over a run.
struct StereoSummary {
    std::optional<Distribution> rivalry_fraction;
    std::optional<Distribution> vertical_disparity_px;
    std::optional<Distribution> colour_excess;
};
[[nodiscard]] StereoSummary stereo_summary_of(const ReplayResult& result, std::size_t method);

/// Index of the refresh whose FLIP of --method is the median: the typical picture of a run. `refreshes` is not empty.
[[nodiscard]] std::size_t typical_refresh(const ReplayResult& result);

/// Adds `frames`, `error`, `cause_shares`, `baselines.<method>.error`, `frame_age_ms` and `cost_ms` to a report that
/// has its settings; with two eyes also `stereo` and `baselines.<method>.stereo`.
void add_replay_results(Report& report, const ReplayResult& result);

/// One row per display frame, with two eyes one for each, told apart by a column `eye`: numbers, times, frame age, the
/// share of the pixels with each cause of error, and for each method flip, ssim, psnr_db (empty for equal images),
/// hole_fraction, flip's parts by cause, and flicker (empty for the first frame).
[[nodiscard]] std::string replay_csv(const ReplayResult& result);

/// Plots over time and the table of distributions.
/// @param strip_png  a picture strip to show, may be empty
[[nodiscard]] std::string replay_html(const ReplayResult& result, const std::string& title,
                                      const std::string& description, std::span<const std::uint8_t> strip_png);

}  // namespace lw
