#include "core/reprojection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/task_pool.h"

namespace lw {
namespace {

Camera camera_at(const Pose& world_from_eye) {
    Camera camera;
    camera.world_from_eye = world_from_eye;
    camera.fov = {-1.1, 0.9, -0.7, 0.8};
    camera.near_m = 0.05;
    camera.size_px = {320, 240};
    return camera;
}

Pose turned(double angle_rad, glm::dvec3 axis, glm::dvec3 position_m = {}) {
    return {position_m, glm::angleAxis(angle_rad, glm::normalize(axis))};
}

// Pixel and depth of a world position, straight from the definitions and without the chain under test.
glm::dvec3 pixel_of(const Camera& camera, const glm::dvec3& position_world) {
    const glm::dvec3 eye =
        glm::conjugate(camera.world_from_eye.orientation) * (position_world - camera.world_from_eye.position_m);
    const double distance = -eye.z;
    const FovTangents& fov = camera.fov;
    return {(eye.x / distance - fov.left) / (fov.right - fov.left) * camera.size_px.x,
            (fov.up - eye.y / distance) / (fov.up - fov.down) * camera.size_px.y, camera.near_m / distance};
}

void expect_maps(const Transform<TargetPx, SourcePx>& matrix, const glm::dvec3& from, const glm::dvec3& to,
                 double tolerance_px) {
    const auto sample = reproject(matrix, {from.x, from.y}, from.z);
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->position_px.x, to.x, tolerance_px);
    EXPECT_NEAR(sample->position_px.y, to.y, tolerance_px);
    EXPECT_NEAR(sample->depth, to.z, 1e-9);
}

// 1e-9 px: double rounding of a chain of five matrices and values of some hundreds.
constexpr double kRounding_px = 1e-9;

TEST(Reprojection, NoMotionIsTheIdentity) {
    const Camera camera = camera_at(turned(0.4, {1, 2, 0}, {5, -3, 2}));
    const auto matrix = static_target_px_from_source_px(camera, camera);
    for (const double depth : {0.0, 1e-3, 0.5, 1.0}) {
        for (const double x_px : {0.5, 160.0, 319.5}) {
            expect_maps(matrix, {x_px, 77.5, depth}, {x_px, 77.5, depth}, kRounding_px);
        }
    }
}

TEST(Reprojection, RotationIsOneHomographyForAllDepths) {
    const Camera source = camera_at({});
    const Camera target = camera_at(turned(0.1, {0.2, 1, 0.1}));
    const auto matrix = static_target_px_from_source_px(source, target);
    const auto background = reproject(matrix, {100.5, 60.5}, 0.0);
    const auto near = reproject(matrix, {100.5, 60.5}, 0.9);
    ASSERT_TRUE(background && near);
    EXPECT_NEAR(background->position_px.x, near->position_px.x, kRounding_px);
    EXPECT_NEAR(background->position_px.y, near->position_px.y, kRounding_px);
    EXPECT_EQ(background->depth, 0.0);
    // The ray's own homography: rotate, project.
    const glm::dvec4 ray = source_eye_from_source_px(source).matrix * glm::dvec4{100.5, 60.5, 1.0, 0.0};
    const glm::dvec3 expected = pixel_of(target, glm::dvec3{ray} * 1.0);
    EXPECT_NEAR(background->position_px.x, expected.x, kRounding_px);
    EXPECT_NEAR(background->position_px.y, expected.y, kRounding_px);
}

TEST(Reprojection, SkyNeverTranslates) {
    const Camera source = camera_at({});
    const auto matrix = static_target_px_from_source_px(source, camera_at({{3, 2, 1}, {1, 0, 0, 0}}));
    expect_maps(matrix, {10.5, 20.5, 0.0}, {10.5, 20.5, 0.0}, kRounding_px);
}

TEST(Reprojection, PointsOfAPlaneGoWhereTheyAreSeen) {
    const Camera source = camera_at(turned(-0.2, {0, 1, 0}, {0, 1.6, 0}));
    const Camera target = camera_at(turned(0.05, {1, 1, 0}, {0.3, 1.5, -0.4}));
    const auto matrix = static_target_px_from_source_px(source, target);
    for (int i = -3; i <= 3; ++i) {
        const glm::dvec3 on_floor{0.5 * i, 0.0, -3.0 - 0.3 * i};
        expect_maps(matrix, pixel_of(source, on_floor), pixel_of(target, on_floor), kRounding_px);
    }
}

TEST(Reprojection, MoversCarryTheirPixelsAlong) {
    const Camera source = camera_at(turned(0.1, {0, 1, 0}));
    const Camera target = camera_at(turned(0.15, {0, 1, 0}, {0.1, 0, 0}));
    const glm::dmat4 at_source = matrix_of(turned(0.3, {0, 1, 0}, {0.2, 0, -4}));
    glm::dmat4 at_target = matrix_of(turned(0.9, {0.3, 1, 0}, {0.5, 0.1, -3.5}));
    at_target[0] *= 1.5;  // it also grows
    const auto matrix = mover_target_px_from_source_px(source, target, at_source, at_target);
    ASSERT_TRUE(matrix);
    const glm::dvec4 corner_object{0.3, -0.2, 0.1, 1.0};
    expect_maps(*matrix, pixel_of(source, glm::dvec3{at_source * corner_object}),
                pixel_of(target, glm::dvec3{at_target * corner_object}), kRounding_px);
}

TEST(Reprojection, AMoverThatStandsStillIsStatic) {
    const Camera source = camera_at({});
    const Camera target = camera_at(turned(0.1, {1, 0, 0}, {0, 0, 1}));
    const glm::dmat4 placement = matrix_of(turned(1.0, {1, 1, 1}, {1, 2, -5}));
    const auto mover = mover_target_px_from_source_px(source, target, placement, placement);
    ASSERT_TRUE(mover);
    const auto fixed = reproject(static_target_px_from_source_px(source, target), {33.5, 44.5}, 0.02);
    expect_maps(*mover, {33.5, 44.5, 0.02}, {fixed->position_px, fixed->depth}, kRounding_px);
}

TEST(Reprojection, TenThousandKilometresFromTheOriginNothingIsLost) {
    const glm::dvec3 far{1e7, -1e7, 1e7};
    const Camera source = camera_at(turned(0.2, {0, 1, 0}));
    const Camera target = camera_at(turned(0.25, {0, 1, 0}, {0.05, 0.02, -0.03}));
    Camera far_source = source;
    Camera far_target = target;
    far_source.world_from_eye.position_m += far;
    far_target.world_from_eye.position_m += far;
    const glm::dmat4 at_source = matrix_of(turned(0.3, {0, 1, 0}, {0.2, 0, -4}));
    const glm::dmat4 at_target = matrix_of(turned(0.4, {0, 1, 0}, {0.4, 0, -4}));
    glm::dmat4 far_at_source = at_source;
    glm::dmat4 far_at_target = at_target;
    far_at_source[3] += glm::dvec4{far, 0.0};
    far_at_target[3] += glm::dvec4{far, 0.0};

    const auto expect_close = [](const Transform<TargetPx, SourcePx>& a, const Transform<TargetPx, SourcePx>& b) {
        for (const double depth : {0.0, 0.0125, 0.05}) {
            const auto from_a = reproject(a, {200.5, 100.5}, depth);
            const auto from_b = reproject(b, {200.5, 100.5}, depth);
            ASSERT_TRUE(from_a && from_b);
            // A double at 1e7 m has steps of 2e-9 m; at 1 m distance and 160 px per unit tangent that is 3e-7 px per
            // rounding. 0.01 px is what a picture could show.
            EXPECT_LT(glm::length(from_a->position_px - from_b->position_px), 0.01);
        }
    };
    expect_close(static_target_px_from_source_px(source, target),
                 static_target_px_from_source_px(far_source, far_target));
    const auto near_mover = mover_target_px_from_source_px(source, target, at_source, at_target);
    const auto far_mover = mover_target_px_from_source_px(far_source, far_target, far_at_source, far_at_target);
    ASSERT_TRUE(near_mover && far_mover);
    expect_close(*near_mover, *far_mover);
}

TEST(Reprojection, NothingBehindTheEyeAndNothingThatIsNotFinite) {
    const auto forward = static_target_px_from_source_px(camera_at({}), camera_at({{0, 0, -3}, {1, 0, 0, 0}}));
    const double depth_of_2_m = 0.05 / 2.0;
    EXPECT_FALSE(reproject(forward, {160, 120}, depth_of_2_m));
    EXPECT_TRUE(reproject(forward, {160, 120}, 0.05 / 4.0));
    EXPECT_FALSE(reproject(forward, {160, 120}, 0.05 / 3.0)) << "in the plane of the eye";
    EXPECT_FALSE(reproject(forward, {160, 120}, std::numeric_limits<double>::quiet_NaN()));
    EXPECT_FALSE(reproject(forward, {160, 120}, std::numeric_limits<double>::infinity()));
}

TEST(Reprojection, NearerThanTheNearPlaneIsReportedAsDepthAboveOne) {
    const auto forward = static_target_px_from_source_px(camera_at({}), camera_at({{0, 0, -1.97}, {1, 0, 0, 0}}));
    const auto sample = reproject(forward, {160, 120}, 0.05 / 2.0);  // now 3 cm ahead, near plane 5 cm
    ASSERT_TRUE(sample);
    EXPECT_NEAR(sample->depth, 0.05 / 0.03, 1e-9);
}

TEST(ReprojectionTable, KnowsIdsInAnyOrderAndMissingOnes) {
    const Camera source = camera_at({});
    const Camera target = camera_at(turned(0.1, {0, 1, 0}));
    const glm::dmat4 placement = matrix_of(turned(0.0, {0, 1, 0}, {0, 0, -4}));
    const glm::dmat4 moved = matrix_of(turned(0.0, {0, 1, 0}, {1, 0, -4}));
    const std::vector<ObjectTransform> at_source{{7, placement}, {3, placement}, {5, glm::dmat4{0.0}}};
    const std::vector<ObjectTransform> at_target{{9, moved}, {3, moved}};

    ReprojectionTable table;
    table.build(source, target, at_source, at_target);
    EXPECT_EQ(table.size(), 8U);
    ASSERT_NE(table.find(0), nullptr);
    EXPECT_EQ(table.find(0)->matrix, static_target_px_from_source_px(source, target).matrix);
    ASSERT_NE(table.find(3), nullptr);
    EXPECT_EQ(table.find(3)->matrix, mover_target_px_from_source_px(source, target, placement, moved)->matrix);
    ASSERT_NE(table.find(7), nullptr) << "without a target placement it holds its source one";
    EXPECT_EQ(table.find(7)->matrix, mover_target_px_from_source_px(source, target, placement, placement)->matrix);
    EXPECT_EQ(table.find(1), nullptr) << "no placement";
    EXPECT_EQ(table.find(5), nullptr) << "singular";
    EXPECT_EQ(table.find(9), nullptr) << "not drawn in the source";
    EXPECT_EQ(table.find(65535), nullptr);
}

TEST(ReprojectionTable, IsTheSameOnSeveralThreads) {
    const Camera source = camera_at({{0.0, 1.6, 0.0}, {1, 0, 0, 0}});
    const Camera target = camera_at({{0.1, 1.6, -0.2}, {1, 0, 0, 0}});
    std::vector<ObjectTransform> at_source;
    std::vector<ObjectTransform> at_target;
    for (ObjectId id = 300; id > 0; --id) {
        const glm::dvec3 place{0.1 * id, 0.0, -3.0};
        at_source.push_back({id, matrix_of(Pose{place})});
        if (id % 3 != 0) at_target.push_back({id, matrix_of(Pose{place + glm::dvec3{0.0, 0.2, 0.0}})});
        if (id % 5 == 0) at_source.back().world_from_object[0][0] = std::numeric_limits<double>::quiet_NaN();
    }
    ReprojectionTable alone;
    ReprojectionTable shared;
    TaskPool threads{3};
    alone.build(source, target, at_source, at_target);
    shared.build(source, target, at_source, at_target, &threads);
    ASSERT_EQ(shared.size(), alone.size());
    for (std::size_t id = 0; id < alone.size(); ++id) {
        const auto* expected = alone.find(static_cast<ObjectId>(id));
        const auto* found = shared.find(static_cast<ObjectId>(id));
        ASSERT_EQ(found == nullptr, expected == nullptr) << "object " << id;
        if (found == nullptr) continue;
        EXPECT_EQ(found->matrix, expected->matrix) << "object " << id;
    }
}

TEST(ReprojectionTable, ForgetsTheLastLayer) {
    const Camera camera = camera_at({});
    ReprojectionTable table;
    const std::vector<ObjectTransform> some{{2, glm::dmat4{1.0}}};
    table.build(camera, camera, some, some);
    table.build(camera, camera, {}, {});
    EXPECT_EQ(table.size(), 1U);
    EXPECT_EQ(table.find(2), nullptr);
}

}  // namespace
}  // namespace lw
