/// What updates look like from frame to frame, with and without cross-fades.

#include <algorithm>
#include <cmath>

#include "apps/billboard_bench_runs.h"

namespace lw {

namespace {

constexpr glm::ivec2 kSize_px{512, 512};
constexpr int kFadeFrames = 8;
/// Two samples per pixel and axis: of one, the noise of sampling hides what updates do.
constexpr int kSamples = 2;

/// Pictures of one way to draw, and what changes from one to the next beyond what changes in the meshes' pictures.
class FlickerMeter {
public:
    explicit FlickerMeter(const ColourImage& first) : before_{first} {}

    void add(const ColourImage& after, const ColourImage& meshes_before, const ColourImage& meshes_after) {
        const double energy = flicker_energy(before_, after, meshes_before, meshes_after);
        sum_ += energy;
        worst_ = std::max(worst_, energy);
        ++count_;
        before_ = after;
    }

    void write(FlickerPoint& point) const {
        point.flicker = std::sqrt(sum_ / std::max(count_, 1));
        point.worst_flicker = std::sqrt(worst_);
    }

private:
    ColourImage before_;
    double sum_ = 0.0;
    double worst_ = 0.0;
    int count_ = 0;
};

FlickerPoint point_of(const BillboardSettings& settings) {
    FlickerPoint point;
    point.mode = name_of(settings.mode);
    point.fade_frames = settings.fade_frames;
    return point;
}

/// Billboards made here are looked at from there, where their updates arrive a few per frame: nothing but them changes
/// the picture.
Status measure_pops(const BillboardStage& stage, const BillboardSettings& settings, int frames,
                    std::vector<FlickerPoint>& into) {
    const Camera here = stage.camera_at(14.0, kSize_px);
    Camera there = here;
    there.world_from_eye.position_m.x += 3.0;
    auto trial = stage.trial("", settings);
    if (!trial.ok()) return trial.error();
    // Twice the frames that creating takes; the first look from there redraws what a budget may not leave.
    for (int k = 0; k < 8; ++k) (void)trial->draw(here, 0.0, kSamples);
    FlickerPoint point = point_of(settings);
    FlickerMeter meter{trial->draw(there, 0.0, kSamples)};
    const ColourImage still{kSize_px};
    for (int k = 0; k < frames; ++k) {
        meter.add(trial->draw(there, 0.0, kSamples), still, still);
        point.updates += trial->frames().back().counters.updated;
    }
    meter.write(point);
    into.push_back(point);
    return Done{};
}

Status measure_moving(const BillboardStage& stage, const BillboardSettings& settings,
                      const std::vector<Camera>& cameras, const std::vector<ColourImage>& meshes,
                      std::vector<FlickerPoint>& into) {
    auto trial = stage.trial("", settings);
    if (!trial.ok()) return trial.error();
    for (int k = 0; k < 5; ++k) (void)trial->draw(cameras.front(), 0.0, kSamples);
    FlickerPoint point = point_of(settings);
    FlickerMeter meter{trial->draw(cameras.front(), 0.0, kSamples)};
    for (std::size_t k = 1; k < cameras.size(); ++k) {
        meter.add(trial->draw(cameras[k], 0.0, kSamples), meshes[k - 1], meshes[k]);
        point.updates += trial->frames().back().counters.updated;
    }
    meter.write(point);
    into.push_back(point);
    return Done{};
}

}  // namespace

Status measure_flicker(const BillboardStage& stage, bool quick, BillboardBench& bench) {
    const std::vector<Camera> cameras = stage.cameras(23.0, quick ? 23.2 : 23.8, 0.05, kSize_px);
    auto meshes = stage.meshes(cameras, kSamples);
    if (!meshes.ok()) return meshes.error();
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        for (const int fade_frames : {0, kFadeFrames}) {
            BillboardSettings settings = by_error(mode, mode == BillboardMode::flat ? 0.4 : 0.8);
            settings.fade_frames = fade_frames;
            Status status = measure_moving(stage, settings, cameras, *meshes, bench.moving);
            if (!status.ok()) return status;
            // Caps at which the step makes the nearer half due, but not by more than a budget may leave for later.
            settings.budget_ms = 20.0;
            status = measure_pops(stage, settings, quick ? 12 : 32, bench.pops);
            if (!status.ok()) return status;
        }
    }
    return Done{};
}

}  // namespace lw
