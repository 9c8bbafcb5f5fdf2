#include "client_renderer/frustum.h"

#include <glm/gtc/quaternion.hpp>

namespace lw {

Frustum frustum_of(const Camera& camera) {
    const FovTangents& fov = camera.fov;
    const glm::dmat3 world_from_eye = glm::mat3_cast(camera.world_from_eye.orientation);
    const glm::dvec3& eye_world = camera.world_from_eye.position_m;
    // In eye space distance = -z, so x >= left * distance reads x + left * z >= 0.
    const std::array<glm::dvec3, 5> normals_eye{glm::dvec3{1.0, 0.0, fov.left}, glm::dvec3{-1.0, 0.0, -fov.right},
                                                glm::dvec3{0.0, 1.0, fov.down}, glm::dvec3{0.0, -1.0, -fov.up},
                                                glm::dvec3{0.0, 0.0, -1.0}};
    Frustum frustum;
    for (std::size_t i = 0; i < normals_eye.size(); ++i) {
        const glm::dvec3 normal = world_from_eye * normals_eye[i];
        frustum.planes[i] = {normal, -glm::dot(normal, eye_world)};
    }
    // Nothing nearer than the near plane is drawn.
    frustum.planes[4].w -= camera.near_m;
    return frustum;
}

FloatFrustum rounded(const Frustum& frustum) {
    FloatFrustum single;
    for (std::size_t i = 0; i < frustum.planes.size(); ++i) {
        const glm::vec4 plane{frustum.planes[i]};
        single.planes[i] = {plane.x, plane.y, plane.z, plane.w};
    }
    return single;
}

bool may_see(const Frustum& frustum, const scene::Bounds& bounds_world) {
    if (bounds_world.empty()) return false;
    const glm::dvec3 centre = bounds_world.centre();
    const glm::dvec3 half_size = bounds_world.half_size();
    for (const glm::dvec4& plane : frustum.planes) {
        const glm::dvec3 normal{plane};
        // The corner that lies farthest along the normal. The margin covers rounding, here and in the float pipeline:
        // 1e-6 of the magnitudes involved.
        const double reach = glm::dot(glm::abs(normal), half_size);
        const double magnitude = glm::dot(glm::abs(normal), glm::abs(centre)) + reach + glm::abs(plane.w);
        if (glm::dot(normal, centre) + plane.w + reach < -1e-6 * magnitude) return false;
    }
    return true;
}

}  // namespace lw
