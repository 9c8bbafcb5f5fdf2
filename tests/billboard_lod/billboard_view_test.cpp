#include "billboard_lod/billboard_view.h"

#include <gtest/gtest.h>

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include "billboard_lod/object_groups.h"
#include "billboard_lod/update_cost.h"

namespace lw {
namespace {

Camera plain_camera() {
    Camera camera;
    camera.size_px = {1000, 1000};
    return camera;
}

DrawnBillboard ahead() { return {{-0.1, 0.1, glm::dvec2{0.002}, {100, 100}}, 9.0, 11.0, 10.0}; }

AtlasLayout layout() { return atlas_layout(128, 8, {512, 512}); }  // 4 columns, 2 rows

TEST(DepthCoding, GivesAllOfItsRangeToTheBillboard) {
    const DepthCoding coding = depth_coding(9.0, 11.0);
    EXPECT_NEAR(1.0 * coding.scale + coding.offset, 1.0 / 9.0, 2e-4) << "the nearest, with a little room";
    EXPECT_GT(1.0 * coding.scale + coding.offset, 1.0 / 9.0);
    EXPECT_NEAR(0.01 * coding.scale + coding.offset, 1.0 / 11.0, 2e-4);
    // 16 bits over 2 m at 10 m: below a tenth of a millimetre.
    EXPECT_LT(coding.scale / 65535.0 * 100.0, 1e-4);
    EXPECT_GT(depth_coding(5.0, 5.0).scale, 0.0) << "a box without depth";
}

/// Where a relative position lands in the atlas, and its depth.
glm::dvec3 landed(const PaintedView& view, const glm::dvec3& relative, glm::ivec2 size_px) {
    const double w = glm::dot(glm::dvec3{view.clip_w}, relative);
    const glm::dvec2 ndc{glm::dot(glm::dvec3{view.clip_x}, relative) / w,
                         glm::dot(glm::dvec3{view.clip_y}, relative) / w};
    const double z = (view.clip_x.w + view.clip_y.w * w) / w;
    return {0.5 * (ndc.x + 1.0) * size_px.x, 0.5 * (1.0 - ndc.y) * size_px.y, z};
}

TEST(PaintedView, PutsTheFrustumOnItsSlot) {
    Camera camera = plain_camera();
    // Turned a quarter to the left: the eye looks along -x of the world.
    camera.world_from_eye.orientation = glm::angleAxis(glm::half_pi<double>(), glm::dvec3{0.0, 1.0, 0.0});
    const PaintedView view = painted_view(ahead(), layout(), 6, camera);  // column 2, row 1
    const glm::dvec3 upper_left_eye{-0.1 * 9.0, 0.1 * 9.0, -9.0};
    const glm::dvec3 relative = camera.world_from_eye.orientation * upper_left_eye;
    const glm::dvec3 corner = landed(view, relative, layout().size_px());
    EXPECT_NEAR(corner.x, 256.0, 1e-3);
    EXPECT_NEAR(corner.y, 128.0, 1e-3);
    EXPECT_LE(corner.z, 1.0);
    EXPECT_NEAR(corner.z, 1.0, 0.01);
    const glm::dvec3 middle =
        landed(view, camera.world_from_eye.orientation * glm::dvec3{0.0, 0.0, -11.0}, layout().size_px());
    EXPECT_NEAR(middle.x, 256.0 + 50.0, 1e-3);
    EXPECT_NEAR(middle.y, 128.0 + 50.0, 1e-3);
    EXPECT_NEAR(middle.z, 0.01, 0.01);
    EXPECT_GT(middle.z, 0.0) << "the farthest point is not mistaken for nothing";
}

TEST(WarpedRecord, LeadsFromAPixelsRayToTheTexelOfItsSurface) {
    const glm::dmat4 now =
        glm::rotate(glm::translate(glm::dmat4{1.0}, {-0.4, 0.2, 0.3}), 0.05, glm::dvec3{0.3, 1.0, 0.1});
    const auto record = warped_record(ahead(), layout(), 0, now, plain_camera());
    ASSERT_TRUE(record.has_value());
    // A point at texel (30.5, 60.5), 9.7 m from the eye that drew it.
    const double distance_m = 9.7;
    const glm::dvec3 drawn{(-0.1 + 0.002 * 30.5) * distance_m, (0.1 - 0.002 * 60.5) * distance_m, -distance_m};
    const glm::dvec3 place{now * glm::dvec4{drawn, 1.0}};
    const double q = 1.0 / -place.z;
    const glm::dvec3 ray = place * q;
    const auto row = [&](const glm::vec4& r) { return glm::dot(glm::dvec3{r}, ray) + q * r.w; };
    const double w = row(record->texel_w);
    EXPECT_NEAR(row(record->texel_x) / w, 30.5, 2e-3);
    EXPECT_NEAR(row(record->texel_y) / w, 60.5, 2e-3);
    EXPECT_NEAR(q / w, 1.0 / distance_m, 1e-6) << "inverse distance when drawn";
    EXPECT_GE(q, record->range.y);
    EXPECT_LE(q, record->range.x);
    EXPECT_GT(record->extent.w, 1.0f) << "more than a texel of parallax";
}

TEST(WarpedRecord, ALookFromTheSamePlaceNeedsNoSearch) {
    const auto record = warped_record(ahead(), layout(), 0, glm::dmat4{1.0}, plain_camera());
    ASSERT_TRUE(record.has_value());
    EXPECT_EQ(record->extent.w, 1.0f);
    EXPECT_EQ(record->slot, glm::vec4(0.0f, 0.0f, 100.0f, 100.0f));
}

TEST(WarpedRecord, AcrossTheNearPlaneThereIsNone) {
    const glm::dmat4 into = glm::translate(glm::dmat4{1.0}, {0.0, 0.0, 8.97});
    EXPECT_FALSE(warped_record(ahead(), layout(), 0, into, plain_camera()).has_value());
    EXPECT_FALSE(flat_record(ahead(), layout(), 0, into, plain_camera()).has_value());
}

TEST(FlatRecord, IsTheQuadOfTheDocument) {
    const glm::dmat4 now = glm::translate(glm::dmat4{1.0}, {0.5, 0.0, 2.0});
    const auto record = flat_record(ahead(), layout(), 5, now, plain_camera());
    ASSERT_TRUE(record.has_value());
    EXPECT_EQ(record->centre, glm::vec4(0.5f, 0.0f, -8.0f, 1.0f)) << "where its centre is now, as wide as it was";
    EXPECT_EQ(record->extent.x, 1.0f);
    EXPECT_EQ(record->depth.z, -2.0f) << "two metres nearer";
    EXPECT_EQ(record->slot, glm::vec4(128.0f, 128.0f, 100.0f, 100.0f));
}

TEST(FlatRecord, WithoutReliefIsAsDeepAsItsPlane) {
    const glm::dmat4 now = glm::translate(glm::dmat4{1.0}, {0.5, 0.0, 2.0});
    auto record = flat_record(ahead(), layout(), 5, now, plain_camera());
    ASSERT_TRUE(record.has_value());
    leave_out_relief(ahead(), *record);
    // As the shader has it: 1 / (texel * x + y) + z, 10 m when drawn and 8 m now, whatever the texel.
    for (const float texel : {0.01f, 1.0f}) {
        EXPECT_NEAR(1.0f / (texel * record->depth.x + record->depth.y) + record->depth.z, 8.0f, 1e-5f);
    }
}

TEST(UpdateCost, FollowsWhatIsMeasured) {
    UpdateCost cost;
    const double before_ms = cost.estimated_ms(6000);
    EXPECT_NEAR(before_ms, 0.7, 0.01);
    for (int frame = 0; frame < 40; ++frame) cost.observe(60000, 10, 20.0 * before_ms);
    EXPECT_NEAR(cost.estimated_ms(6000), 2.0 * before_ms, 0.01 * before_ms);
    cost.observe(0, 0, 100.0);
    EXPECT_NEAR(cost.estimated_ms(6000), 2.0 * before_ms, 0.01 * before_ms) << "nothing was drawn, nothing is learnt";
}

/// Unit boxes at the given places along x; the last `movers` of them move.
scene::Scene row_of_boxes(const std::vector<double>& places, int movers) {
    scene::Scene scene;
    scene::Mesh mesh;
    for (const glm::vec3& corner : {glm::vec3{-0.5f}, glm::vec3{0.5f}, glm::vec3{0.5f, -0.5f, 0.0f}}) {
        scene::Vertex vertex;
        vertex.position_object = corner;
        mesh.vertices.push_back(vertex);
    }
    mesh.indices = {0, 1, 2};
    mesh.primitives = {{0, 3, scene::kNone}};
    scene.meshes.push_back(mesh);
    for (std::size_t i = 0; i < places.size(); ++i) {
        scene::Node node;
        node.translation.x = places[i];
        scene.nodes.push_back(node);
        scene.instances.push_back({0, static_cast<int>(i), glm::dmat4{1.0}, 0});
        if (i + static_cast<std::size_t>(movers) < places.size()) continue;
        scene::AnimationChannel channel;
        channel.node = static_cast<int>(i);
        channel.loop_s = 1.0;
        channel.times_s = {0.0f, 1.0f};
        channel.values = {glm::vec4{places[i], 0.0, 0.0, 0.0}, glm::vec4{places[i], 1.0, 0.0, 0.0}};
        scene.channels.push_back(channel);
    }
    scene.finish();
    return scene;
}

std::vector<std::size_t> group_sizes(const scene::Scene& scene, bool group_touching) {
    scene::SceneState state{scene};
    state.set_time(0.0);
    std::vector<std::size_t> sizes;
    for (const BillboardObject& object :
         billboard_objects(scene, state, std::vector<bool>(scene.instances.size(), true), group_touching)) {
        sizes.push_back(object.instances.size());
    }
    std::ranges::sort(sizes);
    return sizes;
}

TEST(ObjectGroups, WhatTouchesIsOneObject) {
    const scene::Scene scene = row_of_boxes({0.0, 0.9, 5.0, 5.5, 9.0}, 0);
    EXPECT_EQ(group_sizes(scene, true), (std::vector<std::size_t>{1, 2, 2}));
    EXPECT_EQ(group_sizes(scene, false), (std::vector<std::size_t>{1, 1, 1, 1, 1}));
}

TEST(ObjectGroups, MoversStayAlone) {
    EXPECT_EQ(group_sizes(row_of_boxes({0.0, 0.3, 0.6}, 1), true), (std::vector<std::size_t>{1, 2}));
}

TEST(ObjectGroups, ACrowdIsSplit) {
    std::vector<double> places;
    for (int i = 0; i < 20; ++i) places.push_back(0.4 * i);
    for (const std::size_t size : group_sizes(row_of_boxes(places, 0), true)) EXPECT_LE(size, kMaxGroupSize);
}

}  // namespace
}  // namespace lw
