#include "core/camera_picture.h"

namespace lw {

Camera at_pose(Camera camera, const Pose& pose) {
    camera.world_from_eye = pose;
    return camera;
}

glm::dvec3 direction_at(const Camera& camera, double x, double y) {
    const FovTangents& fov = camera.fov;
    const glm::dvec3 ray{glm::mix(fov.left, fov.right, x), glm::mix(fov.up, fov.down, y), -1.0};
    return camera.world_from_eye.orientation * ray;
}

bool sees(const Camera& camera, const glm::dvec3& direction_world) {
    const glm::dvec3 ray = glm::conjugate(camera.world_from_eye.orientation) * direction_world;
    if (ray.z >= 0.0) return false;
    const double x = ray.x / -ray.z;
    const double y = ray.y / -ray.z;
    return x >= camera.fov.left && x <= camera.fov.right && y >= camera.fov.down && y <= camera.fov.up;
}

}  // namespace lw
