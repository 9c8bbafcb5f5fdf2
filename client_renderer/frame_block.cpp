#include "client_renderer/frame_block.h"

#include <glm/gtc/quaternion.hpp>

#include "client_renderer/light_tiles.h"

namespace lw {

shader::FrameBlock frame_block(const Camera& camera, const scene::Sun& sun) {
    const glm::dmat3 relative_from_eye = glm::mat3_cast(camera.world_from_eye.orientation);
    const glm::dmat4 eye_from_relative{glm::transpose(relative_from_eye)};
    const glm::dmat4 clip_from_relative = target_clip_from_target_eye(camera).matrix * eye_from_relative;
    const glm::dmat4 rows = glm::transpose(clip_from_relative);
    const glm::dmat4 eye_from_px = source_eye_from_source_px(camera).matrix;
    const auto ray = [&](int column) {
        return glm::vec4{glm::vec3{relative_from_eye * glm::dvec3{eye_from_px[column]}}, 0.0f};
    };

    shader::FrameBlock block{};
    block.clip_x = rows[0];
    block.clip_y = rows[1];
    block.clip_w = rows[3];
    block.ray_per_px_x = ray(0);
    block.ray_per_px_y = ray(1);
    block.ray_origin = ray(2);
    block.sun_direction = glm::vec4{glm::vec3{sun.direction_to_sun_world}, 0.0f};
    block.sun_irradiance = glm::vec4{sun.irradiance, 0.0f};
    block.near_m.x = static_cast<float>(camera.near_m);
    block.tiles.x = LightTiles::tiles_for(camera.size_px).x;
    return block;
}

}  // namespace lw
