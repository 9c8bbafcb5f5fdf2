/// A camera that stands still, over the overview: layouts, ways to make quads, groups, billboards without depth.

#include <glm/gtc/quaternion.hpp>

#include "apps/billboard_bench_runs.h"
#include "core/metrics.h"

namespace lw {

namespace {

constexpr int kNoLimit = 100000;
constexpr double kNoCap_px = 1000.0;
constexpr double kStep_m = 3.0;

struct Motion {
    double beside_m = 0.0;
    double turned_deg = 0.0;
};

/// Measures settings against the meshes' picture of one camera.
class StillCamera {
public:
    StillCamera(const BillboardStage& stage, int frames, Camera camera, ColourImage meshes)
        : stage_{stage}, frames_{frames}, camera_{std::move(camera)}, meshes_{std::move(meshes)} {}

    /// The billboards were made `beside_m` metres to the left.
    Status measure(std::string label, const BillboardSettings& settings, double beside_m,
                   std::vector<StillPoint>& into) {
        return measure(std::move(label), settings, {beside_m, 0.0}, into);
    }

    /// They were made there, and turned away to the left.
    Status measure(std::string label, BillboardSettings settings, const Motion& motion, std::vector<StillPoint>& into) {
        settings.max_updates = settings.max_creations = kNoLimit;
        auto trial = stage_.trial(std::move(label), settings);
        if (!trial.ok()) return trial.error();
        Camera made_at = camera_;
        made_at.world_from_eye.position_m.x -= motion.beside_m;
        made_at.world_from_eye.orientation = glm::angleAxis(motion.turned_deg * kRadPerDeg, glm::dvec3{0.0, 1.0, 0.0}) *
                                             made_at.world_from_eye.orientation;
        (void)trial->draw(made_at, 0.0);
        StillPoint point;
        const ColourImage& shown = trial->draw(camera_, 0.0);
        point.ssim = ssim(meshes_, shown);
        point.flip = flip(meshes_, shown, pixels_per_degree(camera_)).mean;
        std::vector<double> draw_ms;
        std::vector<double> choose_ms;
        for (int k = 0; k < frames_; ++k) {
            (void)trial->draw(camera_, 0.0);
            const TrialFrame& frame = trial->frames().back();
            point.updates += frame.counters.updated;
            draw_ms.push_back(frame.draw_ms);
            choose_ms.push_back(frame.choose_ms);
        }
        point.label = trial->label();
        point.draw_ms = median_of(draw_ms);
        point.choose_ms = median_of(choose_ms);
        point.bytes_per_texel = bytes_per_texel(settings.format);
        into.push_back(point);
        return Done{};
    }

private:
    const BillboardStage& stage_;
    int frames_;
    Camera camera_;
    ColourImage meshes_;
};

Status measure_layouts(StillCamera& still, BillboardBench& bench) {
    const std::pair<const char*, AtlasFormat> formats[] = {
        {"10 bytes", AtlasFormat::packed}, {"13 bytes", AtlasFormat::document}, {"16 bytes", AtlasFormat::full}};
    for (const auto& [label, format] : formats) {
        BillboardSettings settings = by_error(BillboardMode::warped, 1.0);
        settings.format = format;
        Status status = still.measure(label, settings, 0.0, bench.still);
        if (!status.ok()) return status;
        settings.error_cap_px = kNoCap_px;
        status = still.measure(label, settings, kStep_m, bench.layouts);
        if (!status.ok()) return status;
    }
    for (const int texels_per_px : {1, 2, 4}) {
        BillboardSettings settings = by_error(BillboardMode::warped, kNoCap_px);
        settings.texels_per_px = texels_per_px;
        const Status status = still.measure(fmt::format("10 bytes, {} texels per pixel and more", texels_per_px),
                                            settings, kStep_m, bench.layouts);
        if (!status.ok()) return status;
    }
    return Done{};
}

Status measure_expansions(StillCamera& still, BillboardBench& bench) {
    const std::pair<const char*, QuadExpansion> expansions[] = {{"geometry shader", QuadExpansion::geometry},
                                                                {"instances", QuadExpansion::instances},
                                                                {"vertices", QuadExpansion::vertices}};
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        for (const auto& [label, expansion] : expansions) {
            BillboardSettings settings = by_error(mode, 1.0);
            settings.expansion = expansion;
            const Status status =
                still.measure(fmt::format("{}, {}", name_of(mode), label), settings, 0.0, bench.expansions);
            if (!status.ok()) return status;
        }
    }
    return Done{};
}

Status measure_groups(StillCamera& still, BillboardBench& bench) {
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        for (const bool grouped : {false, true}) {
            BillboardSettings settings = by_error(mode, kNoCap_px);
            settings.group_touching = grouped;
            const Status status = still.measure(fmt::format("{}, {}", name_of(mode), grouped ? "in groups" : "apart"),
                                                settings, kStep_m, bench.groups);
            if (!status.ok()) return status;
        }
    }
    return Done{};
}

Status measure_depthless(StillCamera& still, BillboardBench& bench) {
    for (const double beyond_m : {1000.0, 60.0, 40.0, 0.0}) {
        BillboardSettings settings = by_error(BillboardMode::flat, kNoCap_px);
        settings.depthless_beyond_m = beyond_m;
        const std::string label =
            beyond_m >= 1000.0 ? "with depth" : fmt::format("without depth beyond {:.0f} m", beyond_m);
        const Status status = still.measure(label, settings, kStep_m, bench.depthless);
        if (!status.ok()) return status;
    }
    return Done{};
}

/// How far flat and warped billboards may be looked at from beside where they were made.
Status measure_motions(StillCamera& still, BillboardBench& bench) {
    const Motion motions[] = {{0.1, 0.0}, {1.0, 0.0}, {4.0, 0.0}, {16.0, 0.0}, {0.0, 5.0}, {0.0, 20.0}};
    for (const Motion& motion : motions) {
        for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
            const std::string label = motion.beside_m > 0.0
                                          ? fmt::format("{}, {} m beside", name_of(mode), motion.beside_m)
                                          : fmt::format("{}, {} degrees turned", name_of(mode), motion.turned_deg);
            const Status status = still.measure(label, by_error(mode, kNoCap_px), motion, bench.motions);
            if (!status.ok()) return status;
        }
    }
    return Done{};
}

}  // namespace

Status measure_still(const BillboardStage& stage, bool quick, BillboardBench& bench) {
    const glm::ivec2 size_px{quick ? 512 : 1024};
    const Camera camera = stage.camera_at(14.0, size_px);
    auto meshes = stage.meshes({camera}, 1);
    if (!meshes.ok()) return meshes.error();
    StillCamera still{stage, quick ? 4 : 10, camera, std::move(meshes->front())};
    for (const auto& measure :
         {measure_layouts, measure_expansions, measure_groups, measure_depthless, measure_motions}) {
        const Status status = measure(still, bench);
        if (!status.ok()) return status;
    }
    return Done{};
}

}  // namespace lw
