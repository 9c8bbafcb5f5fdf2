#pragma once
/// The pictures of one pair of the sweep: sources of a given age and the truth, drawn by the client's renderer.

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/scene_stage.h"
#include "apps/warp_sweep_plan.h"
#include "core/result.h"
#include "frame_link/rendered_frame.h"
#include "frame_link/trace.h"

namespace lw {

/// A scene on the GL context of the calling thread, and a head in it. Used and destroyed on that thread.
class SweepStage {
public:
    /// `previous` is taken over: its GL context always, so that objects made in it stay alive, and its scene if it is
    /// the same one, since loading and uploading is most of the cost.
    [[nodiscard]] static Result<SweepStage> create(const SweepPair& pair, std::optional<SweepStage> previous);

    [[nodiscard]] const gl::Context& context() const { return *stage_.context; }
    [[nodiscard]] SceneRenderer& renderer() { return *stage_.renderer; }

    /// The display's camera at photon time, 90 degrees high, seconds from the trace's start (after its skipped part).
    [[nodiscard]] Camera target_camera(glm::ivec2 size_px, double photon_s) const;
    /// Placements of the movers at photon time.
    [[nodiscard]] std::vector<ObjectTransform> target_movers(double photon_s);
    /// The client's frame: drawn for the head and the movers as they were `frame_age_ms` before photon time, with the
    /// guard band that the head's rotation asks for. Nothing is predicted, so that the age is all that the warp has to
    /// make up for. Not prepared yet.
    [[nodiscard]] std::shared_ptr<Layer> source(const BenchConditions& conditions, double photon_s);

private:
    SweepStage(SceneStage stage, std::string scene, TraceFeed feed);

    SceneStage stage_;
    std::string scene_;
    std::unique_ptr<TraceFeed> feed_;
};

/// Photon time of picture `index` of a pair, seconds: late enough that the oldest source lies after the trace's start.
[[nodiscard]] double photon_s_of(const SweepPlan& plan, std::size_t index);

}  // namespace lw
