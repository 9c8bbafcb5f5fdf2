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
    double path_step_s = 0.6;
    int quality_every = 2;  ///< frames
    double overview_from_s = 8.0;
    double overview_to_s = 18.35;  ///< a few more than 100 frames
    glm::ivec2 sweep_px{512, 512};
    double sweep_from_s = 18.0;  ///< down from the overview until most are near
    double sweep_to_s = 26.1;
    double sweep_step_s = 0.75;
    std::vector<double> flat_caps_px{1.0, 2.0, 4.0, 8.0};
    std::vector<double> warped_caps_px{1.0, 4.0, 16.0, 1000.0};
    std::vector<double> angle_scales{1.0, 4.0};  ///< the document's, and about those of its figures 11 and 12
    std::vector<double> shares{0.1, 0.2, 0.4};
    std::vector<double> budgets_ms{0.0, 20.0};
};

constexpr double kOverviewStep_s = 0.1;
/// Of a source that will be warped, per pixel and axis.
constexpr int kSweepSamples = 2;

Plan plan_of(bool quick) {
    Plan plan;
    if (!quick) return plan;
    plan.path_px = {512, 512};
    plan.path_step_s = 2.0;
    plan.quality_every = 1;
    plan.overview_to_s = 9.0;
    plan.sweep_to_s = 21.1;
    plan.flat_caps_px = {1.0, 4.0};
    plan.warped_caps_px = {2.0, 16.0};
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

    /// One setting over a stretch. Frames until all billboards were made do not count.
    Result<SweepPoint> sweep(const BillboardSettings& settings) {
        auto trial = stage_.trial("", settings);
        if (!trial.ok()) return trial.error();
        for (int k = 0; k < 5; ++k) (void)trial->draw(cameras_.front(), 0.0, kSweepSamples);
        const std::uint64_t made = trial->redraws();
        SweepPoint point;
        point.mode = name_of(settings.mode);
        std::vector<double> frame_ms;
        double worst_update_ms = 0.0;
        const auto count = static_cast<double>(cameras_.size());
        for (std::size_t k = 0; k < cameras_.size(); ++k) {
            const ColourImage& shown = trial->draw(cameras_[k], 0.0, kSweepSamples);
            const TrialFrame& frame = trial->frames().back();
            const double ppd = pixels_per_degree(cameras_[k]);
            const double likeness = ssim(meshes_[k], shown);
            point.ssim += (likeness - 1.0) / count;
            point.worst_ssim = std::min(point.worst_ssim, likeness);
            point.flip += flip(meshes_[k], shown, ppd).mean / count;
            point.flip_truth += flip(truth_[k], shown, ppd).mean / count;
            point.active += static_cast<double>(frame.counters.active) / count;
            frame_ms.push_back(frame.frame_ms - frame.update_ms);
            worst_update_ms = std::max(worst_update_ms, frame.update_ms);
        }
        point.redraws_per_frame = static_cast<double>(trial->redraws() - made) / count;
        std::vector<double> with_updates_ms;
        for (const TrialFrame& frame : trial->frames()) with_updates_ms.push_back(frame.frame_ms);
        with_updates_ms.erase(with_updates_ms.begin(), with_updates_ms.end() - static_cast<std::ptrdiff_t>(count));
        point.frame_ms = median_of(with_updates_ms);
        point.worst_to_median = std::max(1.0, (median_of(frame_ms) + worst_update_ms) / point.frame_ms);
        return point;
    }

    /// Nothing falls out of a queue: the sweep asks what a criterion needs, not what a limit does.
    Status measure(BillboardSettings settings, const char* criterion, double value, std::vector<SweepPoint>& into) {
        settings.max_updates = settings.max_creations = 100000;
        auto point = sweep(settings);
        if (!point.ok()) return point.error();
        point->criterion = criterion;
        point->value = value;
        into.push_back(*point);
        progress_->show(++swept_);
        return Done{};
    }

    Status sweep_criteria(BillboardMode mode, std::vector<SweepPoint>& into) {
        for (const double cap_px : mode == BillboardMode::flat ? plan_.flat_caps_px : plan_.warped_caps_px) {
            const Status status = measure(by_error(mode, cap_px), "error", cap_px, into);
            if (!status.ok()) return status;
        }
        for (const double scale : plan_.angle_scales) {
            BillboardSettings settings = by_angles(mode, 0);
            settings.thresholds.view_deg *= scale;
            settings.thresholds.lateral_deg *= scale;
            settings.thresholds.distance *= scale;
            const Status status = measure(settings, "angles", scale, into);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    Status run_sweeps(BillboardBench& bench) {
        cameras_ = stage_.cameras(plan_.sweep_from_s, plan_.sweep_to_s, plan_.sweep_step_s, plan_.sweep_px);
        auto meshes = stage_.meshes(cameras_, kSweepSamples);
        if (!meshes.ok()) return meshes.error();
        meshes_ = std::move(*meshes);
        auto truth = stage_.truth(cameras_);
        if (!truth.ok()) return truth.error();
        truth_ = std::move(*truth);
        progress_.emplace("billboards: sweeps",
                          plan_.flat_caps_px.size() + plan_.warped_caps_px.size() + 2 * plan_.angle_scales.size() +
                              plan_.shares.size() + plan_.budgets_ms.size(),
                          stage_.quiet());
        auto floor = sweep({});
        if (!floor.ok()) return floor.error();
        bench.meshes = *floor;
        bench.meshes.criterion = "-";
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            const Status status = sweep_criteria(mode, bench.caps);
            if (!status.ok()) return status;
        }
        for (const double share : plan_.shares) {
            BillboardSettings settings = by_angles(BillboardMode::flat, 0);
            settings.mesh_distance_share = share;
            const Status status = measure(settings, "angles", share, bench.thresholds);
            if (!status.ok()) return status;
        }
        for (const double budget_ms : plan_.budgets_ms) {
            BillboardSettings settings = by_error(BillboardMode::warped, 2.0);
            settings.budget_ms = budget_ms;
            const Status status = measure(settings, "error", budget_ms, bench.budgets);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    const BillboardStage& stage_;
    Plan plan_;
    bool quick_;
    std::vector<Camera> cameras_;  ///< of the sweeps
    std::vector<ColourImage> meshes_;
    std::vector<ColourImage> truth_;
    std::optional<Progress> progress_;
    std::uint64_t swept_ = 0;
};

}  // namespace

Result<BillboardBench> run_billboard_bench(const scene::Scene& scene, const Options& options) {
    const BillboardStage stage{scene, options.quiet};
    return Bench{stage, options.quick}.run();
}

}  // namespace lw
