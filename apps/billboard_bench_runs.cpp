#include "apps/billboard_bench_runs.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "apps/progress.h"
#include "core/metrics.h"
#include "core/statistics.h"
#include "frame_link/trace.h"

namespace lw {

namespace {

/// How much is measured.
struct Plan {
    glm::ivec2 path_px{1024, 1024};
    double path_step_s = 0.3;
    int quality_every = 4;  ///< frames
    glm::ivec2 sweep_px{512, 512};
    double sweep_from_s = 17.0;
    double sweep_to_s = 31.0;
    double sweep_step_s = 0.5;
    double flicker_from_s = 23.0;
    double flicker_to_s = 24.2;
    double flicker_step_s = 0.04;  ///< pictures of 25 Hz
    std::vector<double> caps_px{0.25, 0.5, 1.0, 2.0, 4.0};
    std::vector<double> angle_scales{1.0, 2.0, 4.0};
    std::vector<double> shares{0.1, 0.2, 0.4};
};

Plan plan_of(bool quick) {
    Plan plan;
    if (!quick) return plan;
    plan.path_px = {512, 512};
    plan.path_step_s = 1.5;
    plan.quality_every = 1;
    plan.sweep_step_s = 1.4;
    plan.flicker_to_s = 23.4;
    plan.caps_px = {0.5, 2.0, 8.0};
    plan.angle_scales = {1.0};
    return plan;
}

double median_of(std::vector<double> values) {
    if (values.empty()) return 0.0;
    std::sort(values.begin(), values.end());
    return percentile_of_sorted(values, 50.0);
}

BillboardSettings by_angles(BillboardMode mode, int updates) {
    BillboardSettings settings;
    settings.mode = mode;
    settings.criterion = UpdateCriterion::angles;
    settings.max_updates = updates;
    settings.max_creations = updates;
    return settings;
}

BillboardSettings by_error(BillboardMode mode, double cap_px) {
    BillboardSettings settings;
    settings.mode = mode;
    settings.error_cap_px = cap_px;
    settings.max_creations = settings.max_updates;
    return settings;
}

class Bench {
public:
    Bench(const scene::Scene& scene, const Options& options)
        : scene_{scene},
          plan_{plan_of(options.quick)},
          quiet_{options.quiet},
          trace_{load_trace("dive")->placed_at(scene.start_pose.value_or(Pose{}), 0.0)} {}

    Result<BillboardBench> run() {
        BillboardBench bench;
        for (const auto& part : {&Bench::run_path, &Bench::run_sweeps, &Bench::run_flicker, &Bench::run_still}) {
            const Status status = (this->*part)(bench);
            if (!status.ok()) return status.error();
        }
        return bench;
    }

private:
    [[nodiscard]] Camera camera_at(double time_s, glm::ivec2 size_px) const {
        Camera camera;
        camera.size_px = size_px;
        camera.fov = FovTangents::symmetric(90.0 * kRadPerDeg, static_cast<double>(size_px.x) / size_px.y);
        camera.world_from_eye = trace_.at(time_s);
        return camera;
    }

    Status run_path(BillboardBench& bench) {
        auto meshes = BillboardTrial::create("meshes", scene_, {}, clock_);
        if (!meshes.ok()) return meshes.error();
        std::vector<BillboardTrial> trials;
        const std::pair<const char*, BillboardSettings> ways[] = {
            {"flat, 16 updates", by_angles(BillboardMode::flat, 16)},
            {"flat, 64 updates", by_angles(BillboardMode::flat, 64)},
            {"flat, 256 updates", by_angles(BillboardMode::flat, 256)},
            {"warped, 256 updates", by_angles(BillboardMode::warped, 256)},
            {"warped, by error", by_error(BillboardMode::warped, 2.0)}};
        for (const auto& [label, settings] : ways) {
            auto trial = BillboardTrial::create(label, scene_, settings, clock_);
            if (!trial.ok()) return trial.error();
            trials.push_back(std::move(*trial));
        }
        const auto frames = static_cast<int>(std::lround(trace_.duration_s() / plan_.path_step_s));
        Progress progress{"billboards: path", static_cast<std::uint64_t>(frames), quiet_};
        (void)meshes->draw(camera_at(0.0, plan_.path_px), 0.0);  // the first frame of all pays for what it finds cold
        BillboardTrial measured = std::move(*meshes);
        for (int k = 0; k < frames; ++k) {
            const double time_s = k * plan_.path_step_s;
            const Camera camera = camera_at(time_s, plan_.path_px);
            const ColourImage& truth = measured.draw(camera, time_s);
            const bool judged = k % plan_.quality_every == 0;
            PathQuality quality;
            quality.time_s = time_s;
            for (std::size_t i = 0; i < trials.size(); ++i) {
                const ColourImage& shown = trials[i].draw(camera, time_s);
                if (!judged || i < 2) continue;
                (i == 2 ? quality.ssim_flat : i == 3 ? quality.ssim_warped : quality.ssim_ours) = ssim(truth, shown);
            }
            if (judged) bench.path.quality.push_back(quality);
            progress.show(static_cast<std::uint64_t>(k + 1));
        }
        bench.path.size_px = plan_.path_px;
        bench.path.meshes.assign(measured.frames().begin() + 1, measured.frames().end());
        for (const BillboardTrial& trial : trials) bench.path.trials.emplace_back(trial.label(), trial.frames());
        bench.path.bytes = trials.back().bytes();
        return Done{};
    }

    /// The meshes' pictures of a stretch of the path.
    Result<std::vector<ColourImage>> draw_truth(const std::vector<Camera>& cameras) {
        auto meshes = BillboardTrial::create("meshes", scene_, {}, clock_);
        if (!meshes.ok()) return meshes.error();
        std::vector<ColourImage> pictures;
        Progress progress{"billboards: meshes", cameras.size(), quiet_};
        for (const Camera& camera : cameras) {
            pictures.push_back(meshes->draw(camera, 0.0));
            progress.show(pictures.size());
        }
        return pictures;
    }

    [[nodiscard]] std::vector<Camera> stretch(double from_s, double to_s, double step_s) const {
        std::vector<Camera> cameras;
        for (int k = 0; from_s + k * step_s < to_s; ++k) {
            cameras.push_back(camera_at(from_s + k * step_s, plan_.sweep_px));
        }
        return cameras;
    }

    /// One setting over a stretch. Frames until all billboards were made do not count.
    Result<SweepPoint> sweep(const BillboardSettings& settings, const std::vector<Camera>& cameras,
                             const std::vector<ColourImage>& truth) {
        auto trial = BillboardTrial::create("", scene_, settings, clock_);
        if (!trial.ok()) return trial.error();
        for (int k = 0; k < 5; ++k) (void)trial->draw(cameras.front(), 0.0);
        const std::uint64_t made = trial->redraws();
        SweepPoint point;
        point.mode = settings.mode == BillboardMode::flat ? "flat" : "warped";
        std::vector<double> frame_ms;
        for (std::size_t k = 0; k < cameras.size(); ++k) {
            const ColourImage& shown = trial->draw(cameras[k], 0.0);
            const double likeness = ssim(truth[k], shown);
            point.ssim += likeness;
            point.worst_ssim = std::min(point.worst_ssim, likeness);
            point.flip += flip(truth[k], shown, pixels_per_degree(cameras[k])).mean;
            point.active += static_cast<double>(trial->frames().back().counters.active);
            frame_ms.push_back(trial->frames().back().frame_ms);
        }
        const auto count = static_cast<double>(cameras.size());
        point.redraws_per_frame = static_cast<double>(trial->redraws() - made) / count;
        point.ssim = (point.ssim - 1.0) / count;
        point.flip /= count;
        point.active /= count;
        point.frame_ms = median_of(frame_ms);
        return point;
    }

    Status run_sweeps(BillboardBench& bench) {
        const std::vector<Camera> cameras = stretch(plan_.sweep_from_s, plan_.sweep_to_s, plan_.sweep_step_s);
        auto truth = draw_truth(cameras);
        if (!truth.ok()) return truth.error();
        Progress progress{"billboards: sweeps",
                          2 * (plan_.caps_px.size() + plan_.angle_scales.size()) + plan_.shares.size(), quiet_};
        std::uint64_t done = 0;
        const auto measure = [&](BillboardSettings settings, const char* criterion, double value,
                                 std::vector<SweepPoint>& into) -> Status {
            // Nothing falls out of a queue: the sweep asks what a criterion needs, not what a limit does.
            settings.max_updates = settings.max_creations = 100000;
            auto point = sweep(settings, cameras, *truth);
            if (!point.ok()) return point.error();
            point->criterion = criterion;
            point->value = value;
            into.push_back(*point);
            progress.show(++done);
            return Done{};
        };
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            for (const double cap_px : plan_.caps_px) {
                const Status status = measure(by_error(mode, cap_px), "error", cap_px, bench.caps);
                if (!status.ok()) return status;
            }
            for (const double scale : plan_.angle_scales) {
                BillboardSettings settings = by_angles(mode, 256);
                settings.thresholds.view_deg *= scale;
                settings.thresholds.lateral_deg *= scale;
                settings.thresholds.distance *= scale;
                const Status status = measure(settings, "angles", scale, bench.caps);
                if (!status.ok()) return status;
            }
        }
        for (const double share : plan_.shares) {
            BillboardSettings settings = by_angles(BillboardMode::flat, 256);
            settings.mesh_distance_share = share;
            const Status status = measure(settings, "angles", share, bench.thresholds);
            if (!status.ok()) return status;
        }
        return Done{};
    }

    Status run_flicker(BillboardBench& bench) {
        const std::vector<Camera> cameras = stretch(plan_.flicker_from_s, plan_.flicker_to_s, plan_.flicker_step_s);
        auto truth = draw_truth(cameras);
        if (!truth.ok()) return truth.error();
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            for (const int fade_frames : {0, 8}) {
                BillboardSettings settings = mode == BillboardMode::flat ? by_angles(mode, 256) : by_error(mode, 2.0);
                settings.fade_frames = fade_frames;
                auto trial = BillboardTrial::create("", scene_, settings, clock_);
                if (!trial.ok()) return trial.error();
                for (int k = 0; k < 5; ++k) (void)trial->draw(cameras.front(), 0.0);
                FlickerPoint point;
                point.mode = mode == BillboardMode::flat ? "flat" : "warped";
                point.fade_frames = fade_frames;
                ColourImage before = trial->draw(cameras.front(), 0.0);
                for (std::size_t k = 1; k < cameras.size(); ++k) {
                    const ColourImage& after = trial->draw(cameras[k], 0.0);
                    const double energy = flicker_energy(before, after, (*truth)[k - 1], (*truth)[k]);
                    point.flicker += energy;
                    point.worst_flicker = std::max(point.worst_flicker, std::sqrt(energy));
                    before = after;
                }
                point.flicker = std::sqrt(point.flicker / static_cast<double>(cameras.size() - 1));
                bench.flicker.push_back(point);
            }
        }
        return Done{};
    }

    /// A still camera at the overview.
    Result<StillPoint> stand_still(std::string label, const BillboardSettings& settings, const ColourImage& truth,
                                   const Camera& camera, const Camera& made_at) {
        auto trial = BillboardTrial::create(std::move(label), scene_, settings, clock_);
        if (!trial.ok()) return trial.error();
        (void)trial->draw(made_at, 0.0);
        StillPoint point;
        std::vector<double> draw_ms;
        for (int k = 0; k < 12; ++k) {
            const ColourImage& shown = trial->draw(camera, 0.0);
            if (k == 0) {
                point.ssim = ssim(truth, shown);
                point.flip = flip(truth, shown, pixels_per_degree(camera)).mean;
            }
            if (k > 1) {
                point.updates += trial->frames().back().counters.updated;
                draw_ms.push_back(trial->frames().back().draw_ms);
            }
        }
        point.label = trial->label();
        point.draw_ms = median_of(draw_ms);
        point.bytes_per_texel = bytes_per_texel(settings.format);
        return point;
    }

    Status run_still(BillboardBench& bench) {
        const Camera camera = camera_at(14.0, plan_.path_px);
        Camera beside = camera;
        beside.world_from_eye.position_m.x -= 0.6;
        auto truth = draw_truth({camera});
        if (!truth.ok()) return truth.error();
        const auto measure = [&](std::string label, BillboardSettings settings, const Camera& made_at,
                                 std::vector<StillPoint>& into) -> Status {
            settings.max_updates = settings.max_creations = 100000;
            auto point = stand_still(std::move(label), settings, truth->front(), camera, made_at);
            if (!point.ok()) return point.error();
            into.push_back(*point);
            return Done{};
        };
        BillboardSettings settings = by_error(BillboardMode::warped, 1.0);
        Status status = measure("10 bytes", settings, camera, bench.still);
        settings.format = AtlasFormat::full;
        if (status.ok()) status = measure("16 bytes", settings, camera, bench.still);
        settings = by_error(BillboardMode::warped, 1.0);
        settings.texels_per_px = 1;
        if (status.ok()) status = measure("10 bytes, 1 texel per pixel", settings, camera, bench.still);
        const std::pair<const char*, QuadExpansion> expansions[] = {{"geometry shader", QuadExpansion::geometry},
                                                                    {"instances", QuadExpansion::instances},
                                                                    {"vertices", QuadExpansion::vertices}};
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            for (const auto& [label, expansion] : expansions) {
                settings = by_error(mode, 1.0);
                settings.expansion = expansion;
                const std::string name = fmt::format("{}, {}", mode == BillboardMode::flat ? "flat" : "warped", label);
                if (status.ok()) status = measure(name, settings, camera, bench.expansions);
            }
        }
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            for (const bool grouped : {false, true}) {
                settings = by_error(mode, 1000.0);
                settings.group_touching = grouped;
                const std::string name = fmt::format("{}, {}", mode == BillboardMode::flat ? "flat" : "warped",
                                                     grouped ? "in groups" : "apart");
                if (status.ok()) status = measure(name, settings, beside, bench.groups);
            }
        }
        return status;
    }

    const scene::Scene& scene_;
    Plan plan_;
    bool quiet_;
    Trace trace_;
    RealClock clock_;
};

}  // namespace

Result<BillboardBench> run_billboard_bench(const scene::Scene& scene, const Options& options) {
    return Bench{scene, options}.run();
}

}  // namespace lw
