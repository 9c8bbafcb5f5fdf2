#pragma once
/// Placements of a scene's movers for the server, which knows no scene.

#include <mutex>

#include "frame_link/feeds.h"
#include "scene/scene.h"

namespace lw {

/// Evaluates the scene's animations; scene time is seconds of the clock. Its own state, so that the server never waits
/// for the client.
class SceneMoverFeed final : public ObjectTransformFeed {
public:
    explicit SceneMoverFeed(const scene::Scene& scene) : state_{scene} {}  ///< `scene` outlives it

    void placements_at(TimePoint time, std::vector<ObjectTransform>& transforms) const override {
        const std::lock_guard lock{mutex_};
        state_.set_time(seconds_of(time));
        state_.mover_placements(transforms);
    }

private:
    mutable std::mutex mutex_;  ///< uncontested where one thread asks
    mutable scene::SceneState state_;
};

}  // namespace lw
