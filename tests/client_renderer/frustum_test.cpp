#include "client_renderer/frustum.h"

#include <gtest/gtest.h>

#include <random>

namespace lw {
namespace {

Camera camera_at(const glm::dvec3& position_m, const glm::dquat& orientation) {
    Camera camera;
    camera.world_from_eye = {position_m, orientation};
    camera.fov = {-1.2, 0.8, -0.7, 1.1};  // off centre
    camera.size_px = {100, 90};
    return camera;
}

scene::Bounds box(const glm::dvec3& centre, double half_m) { return {centre - half_m, centre + half_m}; }

TEST(Frustum, SeesWhatIsAheadAndNotWhatIsBehind) {
    const Frustum frustum = frustum_of(camera_at({1.0, 2.0, 3.0}, {1.0, 0.0, 0.0, 0.0}));
    EXPECT_TRUE(may_see(frustum, box({1.0, 2.0, -7.0}, 0.1)));
    EXPECT_FALSE(may_see(frustum, box({1.0, 2.0, 13.0}, 0.1)));
    EXPECT_FALSE(may_see(frustum, scene::Bounds{}));
    EXPECT_TRUE(may_see(frustum, box({1.0, 2.0, 3.0}, 0.1))) << "the eye is inside";
    EXPECT_TRUE(may_see(frustum, box({1.0, 2.0, -1e7}, 0.1))) << "there is no far plane";
}

TEST(Frustum, EdgesFollowTheFieldOfView) {
    const Frustum frustum = frustum_of(camera_at({}, {1.0, 0.0, 0.0, 0.0}));
    // At 10 m the view reaches from -12 to 8 in x and from -7 to 11 in y.
    const auto sees = [&](double x, double y) { return may_see(frustum, box({x, y, -10.0}, 0.001)); };
    EXPECT_TRUE(sees(-11.9, 0.0));
    EXPECT_FALSE(sees(-12.1, 0.0));
    EXPECT_TRUE(sees(7.9, 0.0));
    EXPECT_FALSE(sees(8.1, 0.0));
    EXPECT_TRUE(sees(0.0, -6.9));
    EXPECT_FALSE(sees(0.0, -7.1));
    EXPECT_TRUE(sees(0.0, 10.9));
    EXPECT_FALSE(sees(0.0, 11.1));
}

// Any box with a point in view is kept, wherever the camera is and however it is turned.
TEST(Frustum, NeverLosesABoxWithAPointInView) {
    std::mt19937 random{7};
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    for (int i = 0; i < 20'000; ++i) {
        const double far_away = i % 2 == 0 ? 0.0 : 1e6;
        const glm::dquat orientation =
            glm::normalize(glm::dquat{unit(random), unit(random), unit(random), unit(random)});
        const Camera camera = camera_at(far_away + glm::dvec3{unit(random), unit(random), unit(random)}, orientation);
        const glm::dvec2 tangents{-0.2 + unit(random), 0.2 + 0.9 * unit(random)};
        const double distance_m = camera.near_m + 50.0 * (1.0 + unit(random));
        const glm::dvec3 seen =
            orientation * (glm::dvec3{tangents, -1.0} * distance_m) + camera.world_from_eye.position_m;
        const double size_m = 1.0 + unit(random);
        const glm::dvec3 offset = size_m * glm::dvec3{unit(random), unit(random), unit(random)};
        ASSERT_TRUE(may_see(frustum_of(camera), box(seen + offset, size_m))) << i;
    }
}

}  // namespace
}  // namespace lw
