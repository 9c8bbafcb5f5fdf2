#include "apps/billboard_bench_runs.h"

#include <algorithm>
#include <cmath>

#include "apps/progress.h"
#include "core/metrics.h"

namespace lw {

namespace {

/// How much is measured.
struct Plan {
    glm::ivec2 path_px{1024, 1024};
    double path_step_s = 1.2;
    int quality_every = 2;  ///< frames
    double overview_from_s = 8.0;
    double overview_to_s = 19.05;  ///< 110 frames
    glm::ivec2 sweep_px{512, 512};
    double sweep_from_s = 18.0;  ///< down from the overview until most are near
    double sweep_to_s = 26.1;
    double sweep_step_s = 0.9;
    std::vector<double> flat_caps_px{1.0, 2.0, 4.0};
    std::vector<double> warped_caps_px{1.0, 2.0, 5.0, 10.0, 1000.0};
    std::vector<double> angle_scales{1.0, 4.0};  ///< the document's, and about those of its figures 11 and 12
    std::vector<double> shares{0.1, 0.2, 0.4};
    double walk_at_s = 14.0;  ///< from the overview
    int walk_frames = 7;
    double walk_step_m = 1.5;
    double budget_from_s = 21.5;  ///< at 10 Hz, since a budget slices what one frame brings
    double budget_to_s = 23.75;
    double budget_step_s = 0.1;
    std::vector<double> budgets_ms{0.0, 20.0};
};

constexpr double kOverviewStep_s = 0.1;
constexpr int kFramesToMakeAll = 5;
/// Of a source that will be warped, per pixel and axis.
constexpr int kSweepSamples = 2;

Plan plan_of(bool quick) {
    Plan plan;
    if (!quick) return plan;
    plan.path_px = {512, 512};
    plan.path_step_s = 2.0;
    plan.quality_every = 1;
    plan.overview_to_s = 9.0;
    plan.walk_frames = 3;
    plan.budget_to_s = 21.9;
    plan.sweep_to_s = 21.1;
    plan.flat_caps_px = {1.0, 4.0};
    plan.warped_caps_px = {1.0, 5.0};
    plan.angle_scales = {1.0};
    return plan;
}

class Bench {
public:
    Bench(const BillboardStage& stage, bool quick) : stage_{stage}, plan_{plan_of(quick)}, quick_{quick} {}

    Result<BillboardBench> run() {
        BillboardBench bench;
        Status status = run_path(bench.path);
        if (status.ok()) status = run_overview(bench.overview);
        if (status.ok()) status = run_sweeps(bench);
        if (status.ok()) status = measure_likeness(stage_, quick_, bench);
        if (status.ok()) status = measure_flicker(stage_, quick_, bench);
        if (status.ok()) status = measure_still(stage_, quick_, bench);
        if (!status.ok()) return status.error();
        return bench;
    }

private:
    Result<std::vector<BillboardTrial>> path_trials() const {
        const std::pair<const char*, BillboardSettings> ways[] = {
            {"flat, 16 updates", by_angles(BillboardMode::flat, 16)},
            {"flat, 64 updates", by_angles(BillboardMode::flat, 64)},
            {"flat, 256 updates", by_angles(BillboardMode::flat, 256)},
            {"warped, 256 updates", by_angles(BillboardMode::warped, 256)},
            {"warped, by error", by_error(BillboardMode::warped, 2.0)}};
        std::vector<BillboardTrial> trials;
        for (const auto& [label, settings] : ways) {
            auto trial = stage_.trial(label, settings);
            if (!trial.ok()) return trial.error();
            trials.push_back(std::move(*trial));
        }
        return trials;
    }

    Status run_path(PathRun& path) {
        auto meshes = stage_.trial("meshes", {});
        if (!meshes.ok()) return meshes.error();
        auto trials = path_trials();
        if (!trials.ok()) return trials.error();
        const auto frames = static_cast<int>(std::lround(stage_.duration_s() / plan_.path_step_s));
        Progress progress{"billboards: path", static_cast<std::uint64_t>(frames), stage_.quiet()};
        (void)meshes->draw(stage_.camera_at(0.0, plan_.path_px), 0.0);  // the first of all pays for what it finds cold
        for (int k = 0; k < frames; ++k) {
            const double time_s = k * plan_.path_step_s;
            const Camera camera = stage_.camera_at(time_s, plan_.path_px);
            const ColourImage& truth = meshes->draw(camera, time_s);
            const bool judged = k % plan_.quality_every == 0;
            PathQuality quality;
            quality.time_s = time_s;
            double* const likeness[] = {nullptr, nullptr, &quality.ssim_flat, &quality.ssim_warped, &quality.ssim_ours};
            for (std::size_t i = 0; i < trials->size(); ++i) {
                const ColourImage& shown = (*trials)[i].draw(camera, time_s);
                if (judged && likeness[i] != nullptr) *likeness[i] = ssim(truth, shown);
            }
            if (judged) path.quality.push_back(quality);
            progress.show(static_cast<std::uint64_t>(k + 1));
        }
        path.size_px = plan_.path_px;
        path.meshes.assign(meshes->frames().begin() + 1, meshes->frames().end());
        for (const BillboardTrial& trial : *trials) path.trials.emplace_back(trial.label(), trial.frames());
        path.bytes = trials->back().bytes();
        return Done{};
    }

    Status run_overview(PairRun& overview) {
        auto meshes = stage_.trial("meshes", {});
        if (!meshes.ok()) return meshes.error();
        auto ours = stage_.trial("warped, by error", by_error(BillboardMode::warped, 2.0));
        if (!ours.ok()) return ours.error();
        const std::vector<Camera> cameras =
            stage_.cameras(plan_.overview_from_s, plan_.overview_to_s, kOverviewStep_s, plan_.path_px);
        Progress progress{"billboards: overview", cameras.size(), stage_.quiet()};
        for (std::size_t k = 0; k < cameras.size(); ++k) {
            const double time_s = plan_.overview_from_s + static_cast<double>(k) * kOverviewStep_s;
            (void)meshes->draw(cameras[k], time_s);
            (void)ours->draw(cameras[k], time_s);
            progress.show(k + 1);
        }
        overview.meshes = meshes->frames();
        overview.ours = ours->frames();
        return Done{};
    }

    /// Cameras that every setting of a sweep is measured along, and their pictures of meshes.
    struct Stretch {
        std::vector<Camera> cameras;
        std::vector<ColourImage> meshes;
        std::vector<ColourImage> truth;  ///< none: not compared with
    };

    Result<Stretch> stretch_along(std::vector<Camera> cameras, bool with_truth) const {
        Stretch stretch{std::move(cameras), {}, {}};
        auto meshes = stage_.meshes(stretch.cameras, kSweepSamples);
        if (!meshes.ok()) return meshes.error();
        stretch.meshes = std::move(*meshes);
        if (!with_truth) return stretch;
        auto truth = stage_.truth(stretch.cameras);
        if (!truth.ok()) return truth.error();
        stretch.truth = std::move(*truth);
        return stretch;
    }

    /// One setting over a stretch. Frames until all billboards were made do not count.
    Result<SweepPoint> sweep(const BillboardSettings& settings, const Stretch& along) {
        auto trial = stage_.trial("", settings);
        if (!trial.ok()) return trial.error();
        for (int k = 0; k < kFramesToMakeAll; ++k) (void)trial->draw(along.cameras.front(), 0.0, kSweepSamples);
        const std::uint64_t made = trial->redraws();
        SweepPoint point;
        point.mode = name_of(settings.mode);
        std::vector<double> frame_ms;
        std::vector<double> without_updates_ms;
        double worst_update_ms = 0.0;
        const auto count = static_cast<double>(along.cameras.size());
        for (std::size_t k = 0; k < along.cameras.size(); ++k) {
            const ColourImage& shown = trial->draw(along.cameras[k], 0.0, kSweepSamples);
            const TrialFrame& frame = trial->frames().back();
            compare(shown, along, k, point);
            point.active += static_cast<double>(frame.counters.active) / count;
            frame_ms.push_back(frame.frame_ms);
            without_updates_ms.push_back(frame.frame_ms - frame.update_ms);
            worst_update_ms = std::max(worst_update_ms, frame.update_ms);
        }
        point.redraws_per_frame = static_cast<double>(trial->redraws() - made) / count;
        point.frame_ms = median_of(frame_ms);
        point.worst_to_median = std::max(1.0, (median_of(without_updates_ms) + worst_update_ms) / point.frame_ms);
        return point;
    }

    static void compare(const ColourImage& shown, const Stretch& along, std::size_t k, SweepPoint& point) {
        const auto count = static_cast<double>(along.cameras.size());
        const double ppd = pixels_per_degree(along.cameras[k]);
        const double likeness = ssim(along.meshes[k], shown);
        point.ssim += (likeness - 1.0) / count;
        point.worst_ssim = std::min(point.worst_ssim, likeness);
        point.flip += flip(along.meshes[k], shown, ppd).mean / count;
        if (!along.truth.empty()) point.flip_truth += flip(along.truth[k], shown, ppd).mean / count;
    }

    /// Nothing falls out of a queue: the sweep asks what a criterion needs, not what a limit does.
    Status measure(BillboardSettings settings, const char* criterion, double value, const Stretch& along,
                   std::vector<SweepPoint>& into) {
        settings.max_updates = settings.max_creations = 100000;
        auto point = sweep(settings, along);
        if (!point.ok()) return point.error();
        point->criterion = criterion;
        point->value = value;
        into.push_back(*point);
        progress_->show(++swept_);
        return Done{};
    }

    Status sweep_caps(const Stretch& along, std::vector<SweepPoint>& into) {
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            for (const double cap_px : mode == BillboardMode::flat ? plan_.flat_caps_px : plan_.warped_caps_px) {
                const Status status = measure(by_error(mode, cap_px), "error", cap_px, along, into);
                if (!status.ok()) return status;
            }
        }
        return Done{};
    }

    Status sweep_angles(BillboardMode mode, const Stretch& along, std::vector<SweepPoint>& into) {
        for (const double scale : plan_.angle_scales) {
            BillboardSettings settings = by_angles(mode, 0);
            settings.thresholds.view_deg *= scale;
            settings.thresholds.lateral_deg *= scale;
            settings.thresholds.distance *= scale;
            const Status status = measure(settings, "angles", scale, along, into);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    /// The meshes themselves, then all settings, along `cameras`.
    Status sweep_criteria(const Stretch& along, SweepPoint& meshes, std::vector<SweepPoint>& into) {
        auto floor = sweep({}, along);
        if (!floor.ok()) return floor.error();
        meshes = *floor;
        meshes.criterion = "-";
        const Status status = sweep_caps(along, into);
        return status.ok() ? sweep_angles(BillboardMode::flat, along, into) : status;
    }

    Status sweep_dive(BillboardBench& bench) {
        auto dive = stretch_along(
            stage_.cameras(plan_.sweep_from_s, plan_.sweep_to_s, plan_.sweep_step_s, plan_.sweep_px), true);
        if (!dive.ok()) return dive.error();
        Status status = sweep_criteria(*dive, bench.meshes, bench.caps);
        if (status.ok()) status = sweep_angles(BillboardMode::warped, *dive, bench.caps);
        if (!status.ok()) return status;
        for (const double share : plan_.shares) {
            BillboardSettings settings = by_angles(BillboardMode::flat, 0);
            settings.mesh_distance_share = share;
            status = measure(settings, "angles", share, *dive, bench.thresholds);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    Status sweep_walk(BillboardBench& bench) {
        auto walk = stretch_along(
            stage_.walk_beside(plan_.walk_at_s, plan_.walk_frames, plan_.walk_step_m, plan_.sweep_px), true);
        if (!walk.ok()) return walk.error();
        return sweep_criteria(*walk, bench.meshes_beside, bench.beside);
    }

    Status sweep_budgets(BillboardBench& bench) {
        auto descent = stretch_along(
            stage_.cameras(plan_.budget_from_s, plan_.budget_to_s, plan_.budget_step_s, plan_.sweep_px), false);
        if (!descent.ok()) return descent.error();
        for (const double budget_ms : plan_.budgets_ms) {
            BillboardSettings settings = by_error(BillboardMode::warped, 1.0);
            settings.budget_ms = budget_ms;
            const Status status = measure(settings, "error", budget_ms, *descent, bench.budgets);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    Status run_sweeps(BillboardBench& bench) {
        const std::size_t caps = plan_.flat_caps_px.size() + plan_.warped_caps_px.size();
        progress_.emplace("billboards: sweeps",
                          2 * caps + 3 * plan_.angle_scales.size() + plan_.shares.size() + plan_.budgets_ms.size(),
                          stage_.quiet());
        Status status = sweep_dive(bench);
        if (status.ok()) status = sweep_walk(bench);
        if (status.ok()) status = sweep_budgets(bench);
        return status;
    }

    const BillboardStage& stage_;
    Plan plan_;
    bool quick_;
    std::optional<Progress> progress_;
    std::uint64_t swept_ = 0;
};

}  // namespace

Result<BillboardBench> run_billboard_bench(const scene::Scene& scene, const Options& options) {
    const BillboardStage stage{scene, options.quiet};
    return Bench{stage, options.quick}.run();
}

}  // namespace lw
