#pragma once
/// A client that is slower than its scene: what --load asks for.

#include <memory>

#include "apps/options.h"
#include "client_renderer/scene_renderer.h"

namespace lw {

/// Draws like `renderer`, and before each of the client's frames draws the same view again until `load.triangles` are
/// drawn besides, then waits for `load.stall_ms`. Truth is drawn without load. Takes over `renderer`.
[[nodiscard]] std::unique_ptr<SceneRenderer> with_load(std::unique_ptr<SceneRenderer> renderer, const AppLoad& load);

}  // namespace lw
