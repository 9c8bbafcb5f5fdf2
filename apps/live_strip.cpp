#include "apps/live_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "apps/image_errors.h"
#include "apps/picture_strip.h"
#include "core/metrics.h"
#include "core/statistics.h"
#include "warp_server/frame_warper.h"

namespace lw {
namespace {

// Of the candidates, the one whose head moved more than in three quarters of them.
constexpr double kTellingPercent = 75.0;
constexpr double kAgeTolerance = 0.1;

const SourceView* source_view_of(const LiveResult& result, const DisplayRecord& refresh) {
    if (refresh.frame_index == 0 || refresh.frame_index > result.source_views.size()) return nullptr;
    return &result.source_views[refresh.frame_index - 1];
}

// How far the picture is from its source: the angle turned, and the head's travel as seen against things 3 m away.
double displacement_rad(const Pose& source, const Pose& target) {
    return angle_between_rad(source.orientation, target.orientation) +
           glm::length(target.position_m - source.position_m) / 3.0;
}

RenderedFrame draw_again(const SourceView& view, int source_samples, SceneRenderer& renderer) {
    auto layer = std::make_shared<Layer>();
    layer->camera = view.camera;
    layer->scene_time_s = view.scene_time_s;
    renderer.draw_resolved(view.camera, view.scene_time_s, source_samples, layer->pixels.emplace<CpuPixels>());
    renderer.mover_placements(view.scene_time_s, layer->movers);
    RenderedFrame frame;
    frame.layers = {std::move(layer)};
    return frame;
}

}  // namespace

const DisplayRecord* telling_refresh(const LiveResult& result) {
    std::vector<double> ages_s;
    for (const DisplayRecord& refresh : result.refreshes) {
        if (!refresh.missed()) ages_s.push_back(to_seconds(refresh.photon - refresh.frame_pose_sampled));
    }
    const auto ages = distribution_of(ages_s);
    if (!ages) return nullptr;
    struct Candidate {
        double displacement_rad;
        const DisplayRecord* refresh;
    };
    std::vector<Candidate> candidates;
    for (const DisplayRecord& refresh : result.refreshes) {
        const SourceView* view = source_view_of(result, refresh);
        if (refresh.missed() || view == nullptr) continue;
        const double age_s = to_seconds(refresh.photon - refresh.frame_pose_sampled);
        if (std::abs(age_s - ages->p50) > kAgeTolerance * ages->p50) continue;
        candidates.push_back({displacement_rad(view->camera.world_from_eye, refresh.world_from_head), &refresh});
    }
    if (candidates.empty()) return nullptr;
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.displacement_rad < b.displacement_rad; });
    const double place = kTellingPercent / 100.0 * static_cast<double>(candidates.size() - 1);
    return candidates[static_cast<std::size_t>(place)].refresh;
}

Result<ColourImage> live_strip(const Options& options, const LiveResult& result, const DisplayRecord& refresh,
                               SceneRenderer& renderer) {
    const SourceView* view = source_view_of(result, refresh);
    LW_CHECK(view != nullptr, "a refresh without a rendered frame has no strip");
    const RenderedFrame frame = draw_again(*view, options.source.samples_per_axis, renderer);
    const double photon_s = seconds_of(refresh.photon);
    std::vector<ObjectTransform> movers;
    renderer.mover_placements(photon_s, movers);
    WarpTarget target{options.camera(), movers};
    target.camera.world_from_eye = refresh.world_from_head;

    ColourImage truth;
    renderer.draw_supersampled(target.camera, photon_s, options.truth_samples, truth);

    std::vector<ColourImage> shown;
    std::vector<StripPicture> pictures;
    const std::vector<std::string> methods{"stale", "rotation", options.method};
    shown.reserve(methods.size());
    for (const std::string& method : methods) {
        auto warper = FrameWarper::create(method, options.fill);
        if (!warper) return warper.error();
        shown.push_back(warper->warp(frame, target).colour);
        const ImageErrors errors = errors_against(truth, shown.back(), pixels_per_degree(target.camera));
        const std::string psnr = errors.psnr_db ? fmt::format("PSNR {:.1f} dB", *errors.psnr_db) : "equal";
        pictures.push_back({&shown.back(), {method, fmt::format("FLIP {:.3f}", errors.flip), psnr}});
    }
    pictures.push_back(
        {&truth,
         {"truth", fmt::format("frame age {:.0f} ms", to_ms(refresh.photon - refresh.frame_pose_sampled)),
          fmt::format("motion to photon {:.0f} ms", to_ms(refresh.photon - refresh.pose_sampled))}});
    return picture_strip(pictures);
}

}  // namespace lw
