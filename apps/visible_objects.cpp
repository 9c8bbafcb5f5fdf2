#include "apps/visible_objects.h"

#include <fmt/format.h>

#include <glm/gtc/quaternion.hpp>

namespace lw {

Result<std::unique_ptr<VisibleObjects>> VisibleObjects::create(const scene::Scene& scene) {
    if (scene.instances.size() > kMostObjects) {
        return Error{fmt::format("{} objects are more than ids can tell apart", scene.instances.size()), scene.name,
                     fmt::format("take a scene of at most {} objects", kMostObjects)};
    }
    std::unique_ptr<VisibleObjects> made{new VisibleObjects{scene}};
    auto renderer = SceneRenderer::create(made->scene_, {{.occlusion = false, .portals = false, .clusters = false}});
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

void VisibleObjects::add_seen_within(const Camera& frame, const Camera& camera, double scene_time_s,
                                     std::vector<bool>& seen) {
    renderer_->draw(camera, scene_time_s, pixels_);
    const glm::dmat3 frame_from_world = glm::transpose(glm::mat3_cast(frame.world_from_eye.orientation));
    const glm::dmat3 frame_from_eye = frame_from_world * glm::mat3_cast(camera.world_from_eye.orientation);
    const glm::dvec3 eye_frame =
        frame_from_world * (camera.world_from_eye.position_m - frame.world_from_eye.position_m);
    const FovTangents& fov = camera.fov;
    const glm::dvec2 tan_per_px{(fov.right - fov.left) / camera.size_px.x, (fov.up - fov.down) / camera.size_px.y};
    for (int y = 0; y < camera.size_px.y; ++y) {
        for (int x = 0; x < camera.size_px.x; ++x) {
            const ObjectId id = pixels_.object_id.row(y)[static_cast<std::size_t>(x)];
            if (id == 0 || seen[id - 1U]) continue;
            const double depth = double{pixels_.depth.row(y)[static_cast<std::size_t>(x)]};
            const glm::dvec3 ray{fov.left + (x + 0.5) * tan_per_px.x, fov.up - (y + 0.5) * tan_per_px.y, -1.0};
            const glm::dvec3 place = eye_frame + frame_from_eye * (ray * distance_m(depth, camera.near_m));
            const double ahead_m = -place.z;
            const bool inside = ahead_m >= frame.near_m && place.x >= frame.fov.left * ahead_m &&
                                place.x <= frame.fov.right * ahead_m && place.y >= frame.fov.down * ahead_m &&
                                place.y <= frame.fov.up * ahead_m;
            if (inside) seen[id - 1U] = true;
        }
    }
}

}  // namespace lw
