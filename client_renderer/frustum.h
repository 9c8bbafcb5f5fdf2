#pragma once
/// What a camera can see, as half spaces.

#include <array>
#include <glm/glm.hpp>

#include "core/camera.h"
#include "scene/scene.h"

namespace lw {

/// The half spaces left, right, down, up and in front of the eye (there is no far plane). A world point p is inside one
/// when dot(plane.xyz, p) + plane.w >= 0.
struct Frustum {
    std::array<glm::dvec4, 5> planes{};
};

/// Pure, any thread.
[[nodiscard]] Frustum frustum_of(const Camera& camera);

/// The same in single precision, for many boxes at a time.
struct FloatFrustum {
    struct Plane {
        float x;
        float y;
        float z;
        float w;
    };
    static constexpr unsigned kAllPlanes = 31;  ///< one bit per plane
    std::array<Plane, 5> planes{};
};
[[nodiscard]] FloatFrustum rounded(const Frustum& frustum);

/// False only when the whole box lies outside one half space: it may say yes to a box that is not in view, never no to
/// one that is. False for an empty box. Pure, any thread.
[[nodiscard]] bool may_see(const Frustum& frustum, const scene::Bounds& bounds_world);

}  // namespace lw
