#include "frame_link/drawn_view.h"

#include <gtest/gtest.h>

namespace lw {
namespace {

const FovTangents kLeftFov{-1.376, 0.839, -1.376, 0.9};
const StereoRig kRig = mirrored_rig(0.063, kLeftFov);

Camera display() {
    Camera camera;
    camera.size_px = {64, 48};
    return camera;
}

TEST(DrawnView, NamesOfModesAreThoseOfTheCommandLine) {
    for (const std::string_view name : stereo_mode_names()) {
        const auto mode = find_stereo_mode(name);
        ASSERT_TRUE(mode.has_value());
        EXPECT_EQ(name_of(*mode), name);
    }
    EXPECT_FALSE(find_stereo_mode("three-renders").has_value());
}

TEST(DrawnView, TwoRendersAreEachForTheirEye) {
    const auto views = stereo_views(display(), kRig, StereoMode::two_renders);
    ASSERT_TRUE(views.ok());
    ASSERT_EQ(views->size(), 2U);
    for (const Eye eye : kEyes) {
        const DrawnView& view = (*views)[static_cast<std::size_t>(eye)];
        EXPECT_EQ(view.for_eye, eye);
        EXPECT_EQ(view.name, name_of(eye));
        EXPECT_EQ(view.head_from_view, kRig.eye(eye).head_from_eye);
        EXPECT_EQ(view.camera.fov, kRig.eye(eye).fov);
    }
}

TEST(DrawnView, OneRenderIsForBothFromBetweenThem) {
    const auto views = stereo_views(display(), kRig, StereoMode::one_render);
    ASSERT_TRUE(views.ok());
    ASSERT_EQ(views->size(), 1U);
    EXPECT_FALSE(views->front().for_eye.has_value());
    EXPECT_EQ(views->front().head_from_view, Pose{});
    EXPECT_LT(views->front().camera.fov.left, kLeftFov.left);
    EXPECT_GT(views->front().camera.fov.right, -kLeftFov.left);
}

TEST(DrawnView, ScanLinesStartFromTheRightEye) {
    const auto views = stereo_views(display(), kRig, StereoMode::scanline);
    ASSERT_TRUE(views.ok());
    ASSERT_EQ(views->size(), 1U);
    EXPECT_FALSE(views->front().for_eye.has_value()) << "the left eye is made from it";
    EXPECT_EQ(views->front().head_from_view, kRig.eye(Eye::right).head_from_eye);
}

TEST(DrawnView, ScanLinesAreRefusedWhereTheUpVectorIsNotPerpendicular) {
    StereoRig rolled = kRig;
    for (EyeView& eye : rolled.eyes) eye.head_from_eye.orientation = glm::angleAxis(0.05, glm::dvec3{0.0, 0.0, 1.0});
    const auto views = stereo_views(display(), rolled, StereoMode::scanline);
    ASSERT_FALSE(views.ok());
    EXPECT_NE(views.error().what.find("up vector is not perpendicular"), std::string::npos) << views.error().what;
    EXPECT_TRUE(stereo_views(display(), rolled, StereoMode::one_render).ok());
}

}  // namespace
}  // namespace lw
