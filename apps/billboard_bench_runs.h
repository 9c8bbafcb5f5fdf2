#pragma once
/// The measurements of the suite `billboards`: the path drawn in every way at once, sweeps of thresholds and caps, the
/// flicker of updates, and small comparisons.

#include <string>
#include <vector>

#include "apps/billboard_trial.h"
#include "apps/options.h"
#include "core/result.h"

namespace lw {

/// Quality of a frame against the meshes' frame.
struct PathQuality {
    double time_s = 0.0;
    double ssim_flat = 1.0;    ///< flat quads, updated by the three angles
    double ssim_warped = 1.0;  ///< warped ones, updated by the same angles, so as often
    double ssim_ours = 1.0;    ///< warped ones, updated by their error
};

/// The whole path, all ways in turns within every frame.
struct PathRun {
    glm::ivec2 size_px{0};
    std::vector<TrialFrame> meshes;
    std::vector<std::pair<std::string, std::vector<TrialFrame>>> trials;  ///< the last one is ours
    std::vector<PathQuality> quality;
    std::array<std::size_t, kBillboardDimensions.size()> bytes{};  ///< of the last trial's atlases

    [[nodiscard]] const std::vector<TrialFrame>& ours() const { return trials.back().second; }
};

/// One setting, over a stretch of the path.
struct SweepPoint {
    std::string mode;       ///< "flat", "warped"
    std::string criterion;  ///< "angles", "error"
    double value = 0.0;     ///< times the usual angles, or pixels
    double redraws_per_frame = 0.0;
    double flip = 0.0;  ///< means over frames, against meshes
    double ssim = 1.0;
    double worst_ssim = 1.0;
    double active = 0.0;    ///< billboards per frame
    double frame_ms = 0.0;  ///< median
};

/// What updates look like from frame to frame.
struct FlickerPoint {
    std::string mode;
    int fade_frames = 0;
    double flicker = 0.0;        ///< root of the mean energy
    double worst_flicker = 0.0;  ///< of the worst frame
};

struct StillPoint {
    std::string label;
    double ssim = 1.0;
    double flip = 0.0;
    std::uint64_t updates = 0;  ///< after the first frames
    double draw_ms = 0.0;       ///< median of drawing the billboards
    int bytes_per_texel = 0;
};

struct BillboardBench {
    PathRun path;
    std::vector<SweepPoint> caps;        ///< error caps and angles
    std::vector<SweepPoint> thresholds;  ///< value: share of the scene's diagonal
    std::vector<FlickerPoint> flicker;
    std::vector<StillPoint> still;       ///< by layout, and meshes of nearest texel density
    std::vector<StillPoint> expansions;  ///< by way to make quads
    std::vector<StillPoint> groups;      ///< touching objects apart and in groups, flat, after a step to the side
};

/// `scene` is finished; a GL context is current. Progress on standard error unless quiet.
[[nodiscard]] Result<BillboardBench> run_billboard_bench(const scene::Scene& scene, const Options& options);

}  // namespace lw
