#pragma once
/// The measurements of the suite `billboards`: the flight drawn in every way at once, sweeps of thresholds and caps,
/// what updates look like, and a still camera.

#include <optional>
#include <string>
#include <vector>

#include "apps/billboard_bench_stage.h"
#include "apps/options.h"
#include "core/result.h"

namespace lw {

/// Quality of a frame against the meshes' frame. Frames are more than a second apart, so most quads are fresh.
struct PathQuality {
    double time_s = 0.0;
    double ssim_flat = 1.0;    ///< flat quads, updated by the three angles
    double ssim_warped = 1.0;  ///< warped ones, updated by the same angles, so as often
    double ssim_ours = 1.0;    ///< warped ones, updated by their error
};

/// The whole flight, all ways in turns within every frame.
struct PathRun {
    glm::ivec2 size_px{0};
    std::vector<TrialFrame> meshes;
    std::vector<std::pair<std::string, std::vector<TrialFrame>>> trials;  ///< the last one is ours
    std::vector<PathQuality> quality;
    std::array<std::size_t, kBillboardDimensions.size()> bytes{};  ///< of the last trial's atlases

    [[nodiscard]] const std::vector<TrialFrame>& ours() const { return trials.back().second; }
};

/// What decides when flat and warped quads are drawn anew, the same objects in the same frames.
enum class PairSchedule : std::uint8_t { angles, warped_error };
/// As reports have it.
[[nodiscard]] const char* name_of(PairSchedule schedule);

/// Flat and warped quads with the same redraws, in the frames of a client of one rate. Likeness is to the meshes.
struct LikenessPoint {
    PairSchedule schedule = PairSchedule::angles;
    bool flat_blended = false;  ///< flat ones blend texels as warped ones do
    double client_hz = 0.0;
    int fresh = 0;             ///< frames in which all quads were drawn in this frame: exact, whatever the mode
    int equal = 0;             ///< both equally near, and not all quads fresh
    int better = 0;            ///< warped ones nearer
    int worse = 0;             ///< flat ones nearer
    double fresh_share = 0.0;  ///< of the quads, mean over frames
    double ssim_flat = 0.0;    ///< means over frames
    double ssim_warped = 0.0;
    double worst_loss = 0.0;  ///< SSIM by which flat ones are nearer, at most

    [[nodiscard]] int frames() const { return fresh + equal + better + worse; }
};

/// Meshes and ours alone, frame by frame as a client of 10 Hz draws them.
struct PairRun {
    std::vector<TrialFrame> meshes;
    std::vector<TrialFrame> ours;
};

/// One setting, over a stretch of the flight.
struct SweepPoint {
    std::string mode;       ///< "off", "flat", "warped"
    std::string criterion;  ///< "angles", "error", "-"
    double value = 0.0;     ///< times the usual angles, pixels, or the share within which all are meshes
    double redraws_per_frame = 0.0;
    double flip = 0.0;  ///< means over frames, against meshes of the same samples
    double ssim = 1.0;
    double worst_ssim = 1.0;
    double flip_truth = 0.0;       ///< against antialiased meshes
    double active = 0.0;           ///< billboards per frame
    double frame_ms = 0.0;         ///< median, processor time
    double worst_to_median = 1.0;  ///< the median frame with the costliest updates, to the median frame
};

/// What updates look like from frame to frame.
struct FlickerPoint {
    std::string mode;
    int fade_frames = 0;
    std::uint64_t updates = 0;
    double flicker = 0.0;         ///< from frame to frame beyond the truth's change: root of the mean energy
    double worst_flicker = 0.0;   ///< of the worst frame
    double pop = 0.0;             ///< what updates alone change in a frame, over cells: root of the mean energy
    double pop_by_pixel = 0.0;    ///< the same over single pixels
    double pop_per_update = 0.0;  ///< the root of all the energy over the updates
};

struct StillPoint {
    std::string label;
    double ssim = 1.0;
    double flip = 0.0;
    std::uint64_t updates = 0;  ///< after the first frames
    double draw_ms = 0.0;       ///< median of drawing the billboards
    double choose_ms = 0.0;     ///< median of scoring them
    int bytes_per_texel = 0;
};

struct BillboardBench {
    PathRun path;
    PairRun overview;
    std::vector<LikenessPoint> likeness;  ///< flat against warped, by schedule and rate of the client
    std::vector<SweepPoint> caps;         ///< error caps and angles, on the dive
    std::vector<SweepPoint> beside;       ///< the same on a walk to the side
    std::vector<SweepPoint> thresholds;   ///< value: share of the scene's diagonal
    std::vector<SweepPoint> budgets;      ///< value: milliseconds for updates in a frame; 0: no limit
    SweepPoint meshes;                    ///< what the dive's meshes are like to antialiased ones
    SweepPoint meshes_beside;             ///< and the walk's
    std::vector<FlickerPoint> flicker;    ///< of updates while the eye moves
    std::vector<StillPoint> still;        ///< by layout
    std::vector<StillPoint> layouts;      ///< by layout, after a step to the side
    std::vector<StillPoint> expansions;   ///< by way to make quads
    std::vector<StillPoint> groups;       ///< touching objects apart and in groups, after a step to the side
    std::vector<StillPoint> motions;      ///< flat and warped ones, after steps and turns
    std::vector<StillPoint> depthless;    ///< flat ones with and without depth far away, after a step to the side
};

/// `scene` is finished; a GL context is current. Progress on standard error unless quiet.
[[nodiscard]] Result<BillboardBench> run_billboard_bench(const scene::Scene& scene, const Options& options);

/// Fills likeness: in how many frames warped quads are nearer to the meshes than flat ones drawn anew at the same times
/// (billboard_bench_likeness.cpp).
[[nodiscard]] Status measure_likeness(const BillboardStage& stage, bool quick, BillboardBench& bench);

/// Fills flicker: what cross-fades are worth (billboard_bench_flicker.cpp).
[[nodiscard]] Status measure_flicker(const BillboardStage& stage, bool quick, BillboardBench& bench);

/// Fills still, layouts, expansions, groups, depthless and motions (billboard_bench_still.cpp).
[[nodiscard]] Status measure_still(const BillboardStage& stage, bool quick, BillboardBench& bench);

}  // namespace lw
