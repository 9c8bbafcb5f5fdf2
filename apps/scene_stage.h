#pragma once
/// A scene ready to be drawn on the calling thread.

#include <memory>
#include <string_view>
#include <vector>

#include "apps/options.h"
#include "client_renderer/scene_renderer.h"
#include "core/result.h"
#include "gl/context.h"
#include "scene/scene.h"

namespace lw {

/// Used and destroyed on the thread that made it, whose current context is `context` meanwhile. The order of the
/// members is the order of need: the renderer dies first.
struct SceneStage {
    std::unique_ptr<const scene::Scene> scene;
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<SceneRenderer> renderer;
};

/// The scene of `options` with what its importer mended or left out on standard error, unless quiet.
[[nodiscard]] Result<std::unique_ptr<const scene::Scene>> load_scene_of(const Options& options);

/// The scene on a GL context of its own, which is made current on the calling thread.
[[nodiscard]] Result<SceneStage> make_stage(const Options& options);

/// One line "latewarp: warning: ..." on standard error for each, unless quiet.
void print_warnings(const std::vector<std::string>& warnings, bool quiet);

/// world_from_eye where a viewer of the scene starts. Finished scenes have one.
[[nodiscard]] Pose start_pose_of(const scene::Scene& scene);

}  // namespace lw
