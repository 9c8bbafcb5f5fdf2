#pragma once
/// Which objects a view shows, found by drawing all that are in the field of view: the oracle of what may be skipped.

#include <memory>
#include <vector>

#include "client_renderer/scene_renderer.h"
#include "core/result.h"
#include "scene/scene.h"

namespace lw {

/// Draws a copy of the scene in which every object has an id of its own. Belongs to the GL context that is current when
/// it is made, and to its thread.
class VisibleObjects {
public:
    static constexpr std::size_t kMostObjects = 65535;  ///< ids have 16 bits

    /// A scene of more objects is an error.
    [[nodiscard]] static Result<std::unique_ptr<VisibleObjects>> create(const scene::Scene& scene);

    /// Sets seen[i] for every instance i of the scene that has a pixel in the picture. `seen` has one entry per
    /// instance; what is set stays so.
    void add_seen(const Camera& camera, double scene_time_s, std::vector<bool>& seen);

    /// The same, of pixels whose places lie in the picture of `frame` too: what a view warped from it could show.
    void add_seen_within(const Camera& frame, const Camera& camera, double scene_time_s, std::vector<bool>& seen);

private:
    explicit VisibleObjects(const scene::Scene& scene);

    scene::Scene scene_;
    std::unique_ptr<SceneRenderer> renderer_;
    CpuPixels pixels_;
};

}  // namespace lw
