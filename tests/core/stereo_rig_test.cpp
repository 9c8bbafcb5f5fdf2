#include "core/stereo_rig.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lw::test {
namespace {

constexpr double kIpd_m = 0.063;
const FovTangents kHeadsetFov{-1.376, 0.839, -1.376, 0.9};

Camera display() {
    Camera camera;
    camera.size_px = {1000, 800};
    camera.near_m = 0.05;
    return camera;
}

// The pixel at which `camera` shows a point of the head's space; NaN behind it.
glm::dvec2 pixel_of(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec4 point_eye = inverse_matrix_of(camera.world_from_eye) * glm::dvec4{point, 1.0};
    const glm::dvec4 clip = target_clip_from_target_eye(camera).matrix * point_eye;
    const glm::dvec4 px = target_px_from_target_clip(camera).matrix * clip;
    return px.w > 0.0 ? glm::dvec2{px} / px.w : glm::dvec2{NAN, NAN};
}

bool is_inside(const Camera& camera, const glm::dvec3& point) {
    const glm::dvec2 px = pixel_of(camera, point);
    return px.x >= -1e-6 && px.y >= -1e-6 && px.x <= camera.size_px.x + 1e-6 && px.y <= camera.size_px.y + 1e-6;
}

// Points at the edges and in the middle of what an eye sees, at several distances.
std::vector<glm::dvec3> points_seen_by(const EyeView& eye, double nearest_m) {
    std::vector<glm::dvec3> points;
    for (const double distance : {nearest_m, 1.0, 1000.0}) {
        for (const double x : {eye.fov.left, 0.1, eye.fov.right}) {
            for (const double y : {eye.fov.down, 0.0, eye.fov.up}) {
                const glm::dvec3 point_eye = distance * glm::dvec3{x, y, -1.0};
                points.emplace_back(matrix_of(eye.head_from_eye) * glm::dvec4{point_eye, 1.0});
            }
        }
    }
    return points;
}

TEST(StereoRig, TheRightEyeMirrorsTheLeft) {
    const glm::dquat turn = glm::angleAxis(0.1, glm::normalize(glm::dvec3{0.2, 1.0, 0.3}));
    const StereoRig rig = mirrored_rig(kIpd_m, kHeadsetFov, turn);
    EXPECT_EQ(rig.eye(Eye::left).head_from_eye.position_m.x, -0.5 * kIpd_m);
    EXPECT_EQ(rig.eye(Eye::right).head_from_eye.position_m.x, 0.5 * kIpd_m);
    EXPECT_EQ(rig.eye(Eye::right).fov, (FovTangents{-0.839, 1.376, -1.376, 0.9}));
    const glm::dvec3 ray{0.3, -0.2, -1.0};
    const glm::dvec3 left = rig.eye(Eye::left).head_from_eye.orientation * ray;
    const glm::dvec3 right = rig.eye(Eye::right).head_from_eye.orientation * glm::dvec3{-ray.x, ray.y, ray.z};
    EXPECT_NEAR(glm::distance(left, glm::dvec3{-right.x, right.y, right.z}), 0.0, 1e-15);
}

TEST(StereoRig, AnEyesCameraTurnsWithTheHead) {
    const StereoRig rig = mirrored_rig(kIpd_m, kHeadsetFov);
    const Pose head{{1.0, 2.0, 3.0}, glm::angleAxis(std::acos(0.0), glm::dvec3{0.0, 1.0, 0.0})};
    const Camera right = eye_camera(display(), rig.eye(Eye::right), head);
    // Looking along -X, right is -Z.
    EXPECT_NEAR(glm::distance(right.world_from_eye.position_m, {1.0, 2.0, 3.0 - 0.5 * kIpd_m}), 0.0, 1e-15);
    EXPECT_EQ(right.fov, rig.eye(Eye::right).fov);
    EXPECT_EQ(right.size_px, display().size_px);
    EXPECT_EQ(right.near_m, display().near_m);
}

TEST(StereoRig, TheCentreViewHoldsWhatBothEyesSee) {
    const glm::dquat turns[] = {glm::dquat{1.0, 0.0, 0.0, 0.0}, glm::angleAxis(0.15, glm::dvec3{0.0, 1.0, 0.0}),
                                glm::angleAxis(0.2, glm::normalize(glm::dvec3{0.3, 1.0, -0.4}))};
    for (const glm::dquat& turn : turns) {
        const StereoRig rig = mirrored_rig(kIpd_m, kHeadsetFov, turn);
        const Result<Camera> view = centre_view(display(), rig, 0.3);
        ASSERT_TRUE(view.ok());
        for (const EyeView& eye : rig.eyes) {
            for (const glm::dvec3& point : points_seen_by(eye, 0.3)) EXPECT_TRUE(is_inside(*view, point));
        }
    }
}

TEST(StereoRig, TheCentreViewIsNoWiderThanItMustBe) {
    const StereoRig rig = mirrored_rig(kIpd_m, kHeadsetFov);
    const Result<Camera> view = centre_view(display(), rig, 0.3);
    ASSERT_TRUE(view.ok());
    EXPECT_EQ(view->world_from_eye, Pose{});
    // The edge of the left eye's picture at 0.3 m, and half of what rounding to whole pixels adds.
    const double pixel = (0.839 + 1.376) / 1000.0;
    EXPECT_NEAR(view->fov.left, -1.376 - 0.5 * kIpd_m / 0.3, pixel);
    EXPECT_NEAR(view->fov.right, -view->fov.left, 1e-12);
    EXPECT_NEAR(view->fov.up, 0.9, pixel);
    EXPECT_NEAR((view->fov.right - view->fov.left) / view->size_px.x, pixel, 1e-12) << "an eye's pixels per tangent";
    EXPECT_FALSE(is_inside(*view, glm::dvec3{-0.5 * kIpd_m, 0.0, 0.0} + 0.2 * glm::dvec3{-1.376, 0.0, -1.0}));
}

TEST(StereoRig, AViewFarEnoughBackNeedsNoMargin) {
    const StereoRig rig = mirrored_rig(kIpd_m, FovTangents{});
    EXPECT_NEAR(distance_back_m(rig), 0.5 * kIpd_m, 1e-15) << "90 degrees: as far back as to the side";
    const Result<Camera> view = centre_view(display(), rig, 1e-6, distance_back_m(rig) + 1e-9);
    ASSERT_TRUE(view.ok());
    EXPECT_EQ(view->size_px.y, display().size_px.y);
    EXPECT_LE(view->size_px.x, display().size_px.x + 1);
    for (const EyeView& eye : rig.eyes) {
        for (const glm::dvec3& point : points_seen_by(eye, 0.01)) EXPECT_TRUE(is_inside(*view, point));
    }
}

TEST(StereoRig, EyesWithoutDistanceSeeTheDisplaysPicture) {
    const StereoRig rig = mirrored_rig(0.0, FovTangents{});
    const Result<Camera> view = centre_view(display(), rig);
    ASSERT_TRUE(view.ok());
    EXPECT_EQ(view->size_px, display().size_px);
    EXPECT_NEAR(view->fov.left, -1.0, 1e-12);
    EXPECT_EQ(view->world_from_eye, Pose{});
}

TEST(StereoRig, EyesThatLookApartHaveNoCommonPicture) {
    const StereoRig rig = mirrored_rig(kIpd_m, kHeadsetFov, glm::angleAxis(1.0, glm::dvec3{0.0, 1.0, 0.0}));
    const Result<Camera> view = centre_view(display(), rig);
    ASSERT_FALSE(view.ok());
    EXPECT_EQ(view.error().what, "no single picture holds what both eyes see");
}

TEST(StereoRig, SaysWhyEyesAreNotRectified) {
    const Pose head{{1e4, 2.0, -3e4}, glm::angleAxis(0.7, glm::normalize(glm::dvec3{0.3, 1.0, 0.2}))};
    const auto why = [&](const StereoRig& rig) {
        return why_not_rectified(eye_camera(display(), rig.eye(Eye::left), head),
                                 eye_camera(display(), rig.eye(Eye::right), head));
    };
    EXPECT_EQ(why(mirrored_rig(kIpd_m, kHeadsetFov)), "");
    EXPECT_EQ(why(mirrored_rig(kIpd_m, kHeadsetFov, glm::angleAxis(0.01, glm::dvec3{0.0, 1.0, 0.0}))),
              "the eyes are turned against each other");
    StereoRig raised = mirrored_rig(kIpd_m, kHeadsetFov);
    raised.eyes[1].head_from_eye.position_m.y = 0.001;
    EXPECT_EQ(why(raised), "the up vector is not perpendicular to the axis between the eyes");
    StereoRig rolled = mirrored_rig(kIpd_m, kHeadsetFov);
    for (EyeView& eye : rolled.eyes) eye.head_from_eye.orientation = glm::angleAxis(0.05, glm::dvec3{0.0, 0.0, 1.0});
    EXPECT_EQ(why(rolled), "the up vector is not perpendicular to the axis between the eyes");
    StereoRig set_back = mirrored_rig(kIpd_m, kHeadsetFov);
    set_back.eyes[0].head_from_eye.position_m.z = 0.001;
    EXPECT_EQ(why(set_back), "one eye is in front of the other");
    StereoRig raised_fov = mirrored_rig(kIpd_m, kHeadsetFov);
    raised_fov.eyes[0].fov.up += 0.1;
    EXPECT_EQ(why(raised_fov), "the eyes' pictures differ in their rows");
}

}  // namespace
}  // namespace lw::test
