/// What updates look like from frame to frame, with and without cross-fades.

#include <algorithm>
#include <cmath>

#include "apps/billboard_bench_runs.h"

namespace lw {

namespace {

constexpr glm::ivec2 kSize_px{512, 512};
constexpr int kFadeFrames = 15;    ///< eight steps of the new version, eight of the old one
constexpr int kFramesBefore = 16;  ///< not judged: until as many fades end as begin
constexpr int kCellPx = 4;
/// What a client draws unless told otherwise. With more, a pixel shows one of the surfaces in it, which changes at
/// once.
constexpr int kSamples = 1;

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

/// What the updates of each frame change in it, by themselves: energies over cells and over single pixels.
class PopMeter {
public:
    void add(const ColourImage& without_updates, const ColourImage& shown) {
        cells_ += change_energy(without_updates, shown, kCellPx);
        pixels_ += change_energy(without_updates, shown, 1);
        ++count_;
    }

    void write(FlickerPoint& point) const {
        point.pop = std::sqrt(cells_ / std::max(count_, 1));
        point.pop_by_pixel = std::sqrt(pixels_ / std::max(count_, 1));
        point.pop_per_update = std::sqrt(cells_ / static_cast<double>(std::max<std::uint64_t>(point.updates, 1)));
    }

private:
    double cells_ = 0.0;
    double pixels_ = 0.0;
    int count_ = 0;
};

FlickerPoint point_of(const BillboardSettings& settings) {
    FlickerPoint point;
    point.mode = name_of(settings.mode);
    point.fade_frames = settings.fade_frames;
    return point;
}

Status measure_moving(const BillboardStage& stage, const BillboardSettings& settings, const std::vector<Camera>& before,
                      const std::vector<Camera>& cameras, const std::vector<ColourImage>& meshes,
                      std::vector<FlickerPoint>& into) {
    auto trial = stage.trial("", settings);
    if (!trial.ok()) return trial.error();
    for (int k = 0; k < 5; ++k) (void)trial->draw(before.front(), 0.0, kSamples);
    for (const Camera& camera : before) (void)trial->draw(camera, 0.0, kSamples);
    FlickerPoint point = point_of(settings);
    FlickerMeter meter{trial->draw(cameras.front(), 0.0, kSamples)};
    PopMeter pops;
    for (std::size_t k = 1; k < cameras.size(); ++k) {
        const ColourImage& shown = trial->draw(cameras[k], 0.0, kSamples);
        meter.add(shown, meshes[k - 1], meshes[k]);
        point.updates += trial->frames().back().counters.updated;
        pops.add(trial->draw_without_updates(cameras[k], kSamples), shown);
    }
    meter.write(point);
    pops.write(point);
    into.push_back(point);
    return Done{};
}

}  // namespace

Status measure_flicker(const BillboardStage& stage, bool quick, BillboardBench& bench) {
    constexpr double kFrom_s = 22.8;
    constexpr double kStep_s = 0.05;
    const std::vector<Camera> cameras = stage.cameras(kFrom_s, kFrom_s + (quick ? 0.2 : 0.8), kStep_s, kSize_px);
    const std::vector<Camera> before = stage.cameras(kFrom_s - kFramesBefore * kStep_s, kFrom_s, kStep_s, kSize_px);
    auto meshes = stage.meshes(cameras, kSamples);
    if (!meshes.ok()) return meshes.error();
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        for (const int fade_frames : {0, kFadeFrames}) {
            BillboardSettings settings = by_error(mode, 0.4);
            settings.fade_frames = fade_frames;
            settings.keep_replaced = true;
            // Old and new versions, and those of the last frame.
            settings.capacities = {1024, 1024, 1024, 1024, 512, 128};
            const Status status = measure_moving(stage, settings, before, cameras, *meshes, bench.flicker);
            if (!status.ok()) return status;
        }
    }
    return Done{};
}

}  // namespace lw
