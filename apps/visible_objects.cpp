#include "apps/visible_objects.h"

#include <fmt/format.h>

namespace lw {

Result<std::unique_ptr<VisibleObjects>> VisibleObjects::create(const scene::Scene& scene) {
    if (scene.instances.size() > kMostObjects) {
        return Error{fmt::format("{} objects are more than ids can tell apart", scene.instances.size()), scene.name,
                     fmt::format("take a scene of at most {} objects", kMostObjects)};
    }
    std::unique_ptr<VisibleObjects> made{new VisibleObjects{scene}};
    auto renderer = SceneRenderer::create(made->scene_, {{.skip = false}});
    if (!renderer) return renderer.error();
    made->renderer_ = std::move(renderer).value();
    return made;
}

VisibleObjects::VisibleObjects(const scene::Scene& scene) : scene_{scene} {
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) scene_.instances[i].mover = static_cast<ObjectId>(i + 1);
}

void VisibleObjects::add_seen(const Camera& camera, double scene_time_s, std::vector<bool>& seen) {
    renderer_->draw(camera, scene_time_s, pixels_);
    for (const ObjectId id : pixels_.object_id.pixels()) {
        if (id != 0) seen[id - 1U] = true;
    }
}

}  // namespace lw
