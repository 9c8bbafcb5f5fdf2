#include "apps/scene_stage.h"

#include <cstdio>

#include "scene/built_in.h"

namespace lw {

Result<std::unique_ptr<const scene::Scene>> load_scene_of(const Options& options) {
    Result<scene::Scene> scene = scene::load_scene(options.scene, options.parameters);
    if (!scene) return scene.error();
    print_warnings(scene->warnings, options.quiet);
    return std::unique_ptr<const scene::Scene>{std::make_unique<scene::Scene>(*std::move(scene))};
}

Result<SceneStage> make_stage(const Options& options) {
    SceneStage stage;
    Result<std::unique_ptr<const scene::Scene>> scene = load_scene_of(options);
    if (!scene) return scene.error();
    stage.scene = *std::move(scene);
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    stage.context = *std::move(context);
    stage.context->make_current();
    Result<std::unique_ptr<SceneRenderer>> renderer = SceneRenderer::create(
        *stage.scene, {.culling = options.culling, .billboards = options.billboards, .order = options.draw_order});
    if (!renderer) return renderer.error();
    stage.renderer = *std::move(renderer);
    return stage;
}

void print_warnings(const std::vector<std::string>& warnings, bool quiet) {
    if (quiet) return;
    for (const std::string& warning : warnings) std::fprintf(stderr, "latewarp: warning: %s\n", warning.c_str());
}

Pose start_pose_of(const scene::Scene& scene) { return scene.start_pose.value_or(Pose{}); }

}  // namespace lw
