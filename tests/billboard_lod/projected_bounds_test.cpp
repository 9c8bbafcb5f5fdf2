#include "billboard_lod/projected_bounds.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <limits>

#include "billboard_lod/object_score.h"

namespace lw {
namespace {

Camera plain_camera() {
    Camera camera;
    camera.size_px = {200, 100};
    camera.fov = {-2.0, 2.0, -1.0, 1.0};
    return camera;
}

const scene::Bounds kUnitBox{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};

glm::dmat4 at(double x, double y, double z) { return glm::translate(glm::dmat4{1.0}, {x, y, z}); }

TEST(ProjectedBounds, OfABoxAheadAreThoseOfItsNearFace) {
    const ProjectedBounds bounds = projected(kUnitBox, at(0.0, 0.0, -5.0), plain_camera());
    EXPECT_TRUE(bounds.usable);
    EXPECT_TRUE(bounds.visible);
    // The near face is at 4 m: tangents +-1/4, NDC +-1/8 across (half the field is 2) and +-1/4 upwards.
    EXPECT_DOUBLE_EQ(bounds.ndc_min.x, -0.125);
    EXPECT_DOUBLE_EQ(bounds.ndc_max.x, 0.125);
    EXPECT_DOUBLE_EQ(bounds.ndc_min.y, -0.25);
    EXPECT_DOUBLE_EQ(bounds.ndc_max.y, 0.25);
    EXPECT_DOUBLE_EQ(bounds.nearest_m(), 4.0);
    EXPECT_DOUBLE_EQ(bounds.farthest_m(), 6.0);
    EXPECT_DOUBLE_EQ(bounds.centre_m(), 5.0);
    EXPECT_DOUBLE_EQ(bounds.size_m(), std::sqrt(12.0));
}

TEST(ProjectedBounds, KnowAnOffCentreField) {
    Camera camera = plain_camera();
    camera.fov = {0.0, 2.0, 0.0, 1.0};
    const ProjectedBounds bounds = projected(kUnitBox, at(5.0, 0.0, -5.0), camera);
    EXPECT_DOUBLE_EQ(bounds.ndc_max.x, (6.0 / 4.0 - 1.0) / 1.0) << "the near right edge";
    EXPECT_DOUBLE_EQ(bounds.ndc_min.x, (4.0 / 6.0 - 1.0) / 1.0) << "the far left edge";
}

TEST(ProjectedBounds, OutOfViewIsNotVisible) {
    const Camera camera = plain_camera();
    EXPECT_FALSE(projected(kUnitBox, at(20.0, 0.0, -5.0), camera).visible);
    EXPECT_FALSE(projected(kUnitBox, at(0.0, -20.0, -5.0), camera).visible);
    EXPECT_FALSE(projected(kUnitBox, at(0.0, 0.0, 5.0), camera).visible) << "behind the eye";
    EXPECT_TRUE(projected(kUnitBox, at(8.5, 0.0, -5.0), camera).visible) << "half in";
}

TEST(ProjectedBounds, AroundTheEyeOrAcrossTheNearPlaneCannotBeProjected) {
    const Camera camera = plain_camera();
    for (const double z : {0.0, -1.0, -1.04, 0.9}) {
        const ProjectedBounds bounds = projected(kUnitBox, at(0.0, 0.0, z), camera);
        EXPECT_TRUE(bounds.visible) << z;
        EXPECT_FALSE(bounds.usable) << z;
        EXPECT_EQ(object_score(bounds, 0.0), 0.0) << "a mesh";
    }
    EXPECT_TRUE(projected(kUnitBox, at(0.0, 0.0, -1.06), camera).usable);
}

TEST(ProjectedBounds, EmptyAndInfiniteBoxesAreNeitherUsableNorVisible) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const scene::Bounds& bounds :
         {scene::Bounds{}, scene::Bounds{{-infinity, 0.0, 0.0}, {1.0, 1.0, 1.0}},
          scene::Bounds{{0.0, 0.0, 0.0}, {1.0, std::numeric_limits<double>::quiet_NaN(), 1.0}}}) {
        const ProjectedBounds result = projected(bounds, at(0.0, 0.0, -5.0), plain_camera());
        EXPECT_FALSE(result.usable);
        EXPECT_FALSE(result.visible);
    }
    EXPECT_FALSE(projected(kUnitBox, glm::dmat4{std::numeric_limits<double>::quiet_NaN()}, plain_camera()).visible);
}

TEST(ObjectScore, ThresholdIsAShareOfTheScenesDiagonal) {
    EXPECT_DOUBLE_EQ(mesh_distance_m({{0.0, 0.0, 0.0}, {30.0, 0.0, 40.0}}, 0.2), 10.0);
    EXPECT_EQ(mesh_distance_m({}, 0.2), 0.0);
}

TEST(ObjectScore, FarAndSmallScoresHigh) {
    const Camera camera = plain_camera();
    const ProjectedBounds near_box = projected(kUnitBox, at(0.0, 0.0, -11.0), camera);
    EXPECT_DOUBLE_EQ(object_score(near_box, 5.0), 22.0 / std::sqrt(12.0));
    EXPECT_EQ(object_score(near_box, 10.0), 0.0) << "its near face lies on the threshold: a mesh";
    EXPECT_EQ(object_score(near_box, 11.0), 0.0) << "its far face lies beyond: still a mesh";
    EXPECT_EQ(object_score(projected(kUnitBox, at(0.0, 0.0, 11.0), camera), 5.0), -1.0);
    const scene::Bounds small{glm::dvec3{-0.1}, glm::dvec3{0.1}};
    EXPECT_GT(object_score(projected(small, at(0.0, 0.0, -11.0), camera), 5.0), object_score(near_box, 5.0));
    const scene::Bounds point{glm::dvec3{0.0}, glm::dvec3{0.0}};
    EXPECT_EQ(object_score(projected(point, at(0.0, 0.0, -11.0), camera), 5.0), 0.0) << "no size, no division";
}

}  // namespace
}  // namespace lw
