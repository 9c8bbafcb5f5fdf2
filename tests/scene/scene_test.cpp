// What finish() derives, and placements over time.

#include "scene/scene.h"

#include <gtest/gtest.h>

#include "scene/placement.h"

namespace lw::scene {
namespace {

Mesh unit_box() {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        Vertex vertex;
        vertex.position_object = {corner & 1 ? 0.5f : -0.5f, corner & 2 ? 0.5f : -0.5f, corner & 4 ? 0.5f : -0.5f};
        mesh.vertices.push_back(vertex);
    }
    mesh.indices = {0, 1, 2, 5, 6, 7};
    mesh.primitives = {{0, 6, kNone}};
    return mesh;
}

Node node_at(glm::dvec3 translation, int parent = kNone) {
    Node node;
    node.translation = translation;
    node.parent = parent;
    return node;
}

/// One metre along +X per second, over two seconds.
AnimationChannel slide(int node) {
    AnimationChannel channel;
    channel.node = node;
    channel.loop_s = 2.0;
    channel.times_s = {0.0f, 2.0f};
    channel.values = {{0, 0, 0, 0}, {2, 0, 0, 0}};
    return channel;
}

/// world: 0 static box; 1 animated with a box, below it 2 with a box and 3, animated again, with a box.
Scene scene_with_movers() {
    Scene scene;
    scene.meshes = {unit_box()};
    scene.nodes = {node_at({0, 0, 10}), node_at({0, 0, 0}), node_at({0, 1, 0}, 1), node_at({0, 2, 0}, 1)};
    scene.channels = {slide(1), slide(3)};
    for (int node = 0; node < 4; ++node) {
        Instance instance;
        instance.node = node;
        scene.instances.push_back(instance);
    }
    scene.finish();
    return scene;
}

TEST(Bounds, OfATransformedBoxEncloseItsCorners) {
    Bounds box;
    box.include(glm::dvec3{-1, -2, -3});
    box.include(glm::dvec3{1, 2, 3});
    Placement quarter_turn;
    quarter_turn.translation = {10, 0, 0};
    quarter_turn.rotation = glm::angleAxis(1.5707963267948966, glm::dvec3{0, 0, 1});
    const Bounds turned = transformed(box, matrix_of(quarter_turn));
    EXPECT_NEAR(turned.min.x, 8.0, 1e-12);
    EXPECT_NEAR(turned.max.x, 12.0, 1e-12);
    EXPECT_NEAR(turned.max.y, 1.0, 1e-12);
    EXPECT_NEAR(turned.max.z, 3.0, 1e-12);
    EXPECT_TRUE(transformed(Bounds{}, glm::dmat4{1.0}).empty());
}

TEST(SceneFinish, MoversAreTheNearestAnimatedNodesThatCarryInstances) {
    const Scene scene = scene_with_movers();
    ASSERT_EQ(scene.movers.size(), 2u);
    EXPECT_EQ(scene.movers[0].id, 1);
    EXPECT_EQ(scene.movers[0].node, 1);
    EXPECT_EQ(scene.movers[1].id, 2);
    EXPECT_EQ(scene.movers[1].node, 3);
    EXPECT_EQ(scene.instances[0].mover, 0);
    EXPECT_EQ(scene.instances[1].mover, 1);
    EXPECT_EQ(scene.instances[2].mover, 1);
    EXPECT_EQ(scene.instances[3].mover, 2);
}

TEST(SceneFinish, CountsTrianglesOfAllInstances) { EXPECT_EQ(scene_with_movers().triangle_count(), 4u * 2u); }

TEST(SceneFinish, BoundsHoldAllInstancesAtTimeZero) {
    const Bounds bounds = scene_with_movers().bounds_world;
    EXPECT_EQ(bounds.min, glm::dvec3(-0.5, -0.5, -0.5));
    EXPECT_EQ(bounds.max, glm::dvec3(0.5, 1.5, 10.5));  // node 3's channel replaces its height of 2
}

TEST(SceneFinish, StartsAtEyeHeightAtTheEdgeLookingAtTheCentre) {
    Scene scene;
    scene.meshes = {unit_box()};
    scene.nodes = {node_at({0, 10, 0})};
    scene.nodes[0].scale = {20, 20, 20};
    scene.instances = {Instance{}};
    scene.finish();
    ASSERT_TRUE(scene.start_pose.has_value());
    EXPECT_EQ(scene.start_pose->position_m, glm::dvec3(0, 1.6, 10));
    const glm::dvec3 forward = scene.start_pose->orientation * glm::dvec3{0, 0, -1};
    const glm::dvec3 expected = glm::normalize(glm::dvec3{0, 8.4, -10});
    EXPECT_NEAR(glm::length(forward - expected), 0.0, 1e-12);
}

TEST(SceneFinish, SmallThingsAreLookedAtFromTheirMiddleWithSomeDistance) {
    Scene scene;
    scene.meshes = {unit_box()};
    scene.nodes = {node_at({3, 5, 7})};
    scene.instances = {Instance{}};
    scene.finish();
    ASSERT_TRUE(scene.start_pose.has_value());
    EXPECT_EQ(scene.start_pose->position_m, glm::dvec3(3, 5, 8));
    EXPECT_NEAR(scene.start_pose->orientation.w, 1.0, 1e-12);
}

TEST(SceneFinish, AnEmptySceneStartsAtTheOrigin) {
    Scene scene;
    scene.finish();
    EXPECT_TRUE(scene.bounds_world.empty());
    ASSERT_TRUE(scene.start_pose.has_value());
    EXPECT_EQ(scene.start_pose->position_m, glm::dvec3(0.0));
}

TEST(SceneState, PlacesNodesAtATimeAndAgainAtAnother) {
    const Scene scene = scene_with_movers();
    SceneState state{scene};
    std::vector<ObjectTransform> placements;
    for (const double time_s : {0.5, 1.5, 0.5, 2.5}) {
        state.set_time(time_s);
        const double slid = time_s == 2.5 ? 0.5 : time_s;
        // The channel replaces node 3's own translation, parent and child slide both.
        EXPECT_EQ(glm::dvec3(state.world_from_node(0)[3]), glm::dvec3(0, 0, 10));
        EXPECT_EQ(glm::dvec3(state.world_from_node(2)[3]), glm::dvec3(slid, 1, 0));
        EXPECT_EQ(glm::dvec3(state.world_from_node(3)[3]), glm::dvec3(2.0 * slid, 0, 0));
        state.mover_placements(placements);
        ASSERT_EQ(placements.size(), 2u);
        EXPECT_EQ(placements[1].id, 2);
        EXPECT_EQ(placements[1].world_from_object, state.world_from_node(3));
    }
}

TEST(SceneState, NegativeScaleMirrors) {
    Scene scene;
    scene.nodes = {node_at({0, 0, 0})};
    scene.nodes[0].scale = {-1, 1, 1};
    SceneState state{scene};
    state.set_time(0.0);
    EXPECT_LT(glm::determinant(glm::dmat3{state.world_from_node(0)}), 0.0);
}

TEST(Placement, OfAMatrixAndBack) {
    Placement placement;
    placement.translation = {1, 2, 3};
    placement.rotation = glm::angleAxis(1.0, glm::normalize(glm::dvec3{1, 2, -1}));
    placement.scale = {-2, 0.5, 3};
    const auto again = placement_of(matrix_of(placement));
    ASSERT_TRUE(again.has_value());
    const glm::dmat4 difference = matrix_of(*again) - matrix_of(placement);
    for (int column = 0; column < 4; ++column) EXPECT_NEAR(glm::length(difference[column]), 0.0, 1e-14);
    glm::dmat4 sheared{1.0};
    sheared[1][0] = 0.1;
    EXPECT_FALSE(placement_of(sheared).has_value());
    EXPECT_FALSE(placement_of(glm::dmat4{0.0}).has_value());
}

}  // namespace
}  // namespace lw::scene
