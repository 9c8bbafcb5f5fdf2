#include "client_renderer/draw_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "client_renderer/culling.h"
#include "core/task_pool.h"
#include "scene/built_in.h"
#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

glm::dmat4 at(double x, double y, double z) { return glm::translate(glm::dmat4{1.0}, {x, y, z}); }

class DrawListTest : public testing::Test {
protected:
    DrawListTest() {
        scene_.meshes = {test::square_mesh(scene::kNone), test::square_mesh(scene::kNone)};
        test::add_instance(scene_, 0, at(0.0, 0.0, -5.0));
        test::add_instance(scene_, 1, at(0.0, 0.0, -6.0));
        test::add_instance(scene_, 0, at(0.0, 0.0, 5.0));  // behind
        test::add_instance(scene_, 0, at(1.0, 2.0, -7.0));
        test::add_instance(scene_, 0, glm::scale(at(0.0, 0.0, -8.0), {-1.0, 1.0, 1.0}));
        scene_.finish();
        // Batch 0 draws a part of each mesh, batch 1 a second part of mesh 1.
        batches_ = {{{0, 6, 0, 0, {}}, {1, 3, 6, 4, {}}}, {{1, 3, 9, 4, {}}}};
    }

    scene::Scene scene_;
    std::vector<std::vector<MeshPart>> batches_;
};

TEST_F(DrawListTest, InstancesOfAMeshShareOneCommand) {
    scene::SceneState state{scene_};
    state.set_time(0.0);
    const PlacedInstances placed{scene_, state};
    DrawList list{placed};
    Culling culling{placed, {}};
    list.build(culling.visible(test::plain_camera({64, 64})), test::plain_camera({64, 64}), batches_);

    EXPECT_EQ(culling.counters().tested, 5U);
    EXPECT_EQ(culling.counters().outside, 1U);
    EXPECT_EQ(list.objects_drawn(), 4U);
    ASSERT_EQ(list.ranges().size(), 3U);
    EXPECT_EQ(list.ranges()[0].batch, 0);
    EXPECT_FALSE(list.ranges()[0].mirrored);
    EXPECT_EQ(list.ranges()[0].command_count, 2U);
    EXPECT_TRUE(list.ranges()[1].mirrored);
    EXPECT_EQ(list.ranges()[2].batch, 1);
    EXPECT_EQ(list.commands().size(), 4U);

    const DrawCommand& two_of_mesh_0 = list.commands()[0];
    EXPECT_EQ(two_of_mesh_0.index_count, 6U);
    EXPECT_EQ(two_of_mesh_0.instance_count, 2U);
    const DrawCommand& mirrored = list.commands()[list.ranges()[1].first_command];
    EXPECT_EQ(mirrored.instance_count, 1U);
    EXPECT_EQ(list.instances()[mirrored.base_instance].relative_from_object_rows[0].x, -1.0f);
    const DrawCommand& second_part = list.commands()[list.ranges()[2].first_command];
    EXPECT_EQ(second_part.first_index, 9U);
    EXPECT_EQ(second_part.base_vertex, 4);
    EXPECT_EQ(second_part.base_instance, list.commands()[1].base_instance) << "both parts read the same instances";
    EXPECT_EQ(list.triangles_drawn(), 2U * 2U + 1U + 2U + 1U);
}

TEST_F(DrawListTest, TransformsAreRelativeToTheEye) {
    scene::SceneState state{scene_};
    state.set_time(0.0);
    const PlacedInstances placed{scene_, state};
    DrawList list{placed};
    Camera camera = test::plain_camera({64, 64});
    camera.world_from_eye.position_m = {0.25, 0.5, 1.0};
    Culling culling{placed, {}};
    list.build(culling.visible(camera), camera, batches_);
    const PackedInstance& second = list.instances()[1];
    EXPECT_EQ(second.relative_from_object_rows[0], (glm::vec4{1.0f, 0.0f, 0.0f, 0.75f}));
    EXPECT_EQ(second.relative_from_object_rows[1], (glm::vec4{0.0f, 1.0f, 0.0f, 1.5f}));
    EXPECT_EQ(second.relative_from_object_rows[2], (glm::vec4{0.0f, 0.0f, 1.0f, -8.0f}));
}

TEST_F(DrawListTest, WithoutCullingEverythingIsThere) {
    scene::SceneState state{scene_};
    state.set_time(0.0);
    const PlacedInstances placed{scene_, state};
    DrawList list{placed};
    Culling culling{placed, {.skip = false}};
    list.build(culling.visible(test::plain_camera({64, 64})), test::plain_camera({64, 64}), batches_);
    EXPECT_EQ(list.objects_drawn(), 5U);
}

TEST_F(DrawListTest, MoversAreTestedWhereTheyAre) {
    scene::AnimationChannel channel;
    channel.node = 0;
    channel.loop_s = 10.0;
    channel.times_s = {0.0f, 10.0f};
    channel.values = {{0.0f, 0.0f, -5.0f, 0.0f}, {0.0f, 0.0f, 15.0f, 0.0f}};
    scene_.nodes[0].matrix.reset();
    scene_.channels.push_back(channel);
    scene_.finish();
    scene::SceneState state{scene_};
    state.set_time(0.0);
    PlacedInstances placed{scene_, state};
    DrawList list{placed};
    Culling culling{placed, {}};
    const Camera camera = test::plain_camera({64, 64});
    list.build(culling.visible(camera), camera, batches_);
    EXPECT_EQ(list.objects_drawn(), 4U);
    EXPECT_EQ(list.instances()[0].object_id, 1U);
    state.set_time(8.0);  // at z = 11, behind the eye
    placed.move(state);
    culling.move();
    list.build(culling.visible(camera), camera, batches_);
    EXPECT_EQ(list.objects_drawn(), 3U);
}

TEST_F(DrawListTest, ABufferSortsByStateWhatComesByDistance) {
    scene::SceneState state{scene_};
    state.set_time(0.0);
    const PlacedInstances placed{scene_, state};
    const Camera camera = test::plain_camera({64, 64});
    Culling culling{placed, {.skip = false}};
    const std::vector<std::uint32_t> visible = culling.visible(camera);
    DrawList grouped{placed};
    grouped.build(visible, camera, batches_);
    DrawList as_they_come{placed, {false, SortingStrategy::none, 1}};
    as_they_come.build(visible, camera, batches_);
    DrawList sorted{placed, {false, SortingStrategy::lru, 64}};
    sorted.build(visible, camera, batches_);
    EXPECT_EQ(as_they_come.triangles_drawn(), grouped.triangles_drawn());
    EXPECT_EQ(sorted.triangles_drawn(), grouped.triangles_drawn());
    EXPECT_EQ(as_they_come.arriving_states(), sorted.arriving_states());
    EXPECT_EQ(sorted.commands().size(), as_they_come.commands().size());
    const std::set<std::uint32_t> states(sorted.arriving_states().begin(), sorted.arriving_states().end());
    EXPECT_EQ(sorted.ranges().size(), states.size()) << "a buffer for all of them sorts all";
    EXPECT_GE(as_they_come.ranges().size(), states.size());
    std::size_t next = 0;
    for (const DrawRange& range : sorted.ranges()) {
        EXPECT_EQ(range.first_command, next);
        next += range.command_count;
    }
    EXPECT_EQ(next, sorted.commands().size());
}

bool same_command(const DrawCommand& a, const DrawCommand& b) {
    return a.index_count == b.index_count && a.instance_count == b.instance_count && a.first_index == b.first_index &&
           a.base_vertex == b.base_vertex && a.base_instance == b.base_instance;
}

TEST(DrawListThreads, AnyNumberOfThreadsListsTheSameClusters) {
    auto city = scene::make_built_in("city", {{"buildings", 60.0}});
    ASSERT_TRUE(city.ok());
    Clusters clusters;
    std::vector<std::vector<MeshPart>> batches(1);
    for (std::size_t mesh = 0; mesh < city->meshes.size(); ++mesh) {
        clusters.begin_mesh();
        std::vector<std::uint32_t> indices = city->meshes[mesh].indices;
        const ClusterRange range = clusters.add(city->meshes[mesh].vertices, indices, false);
        batches[0].push_back({static_cast<int>(mesh), static_cast<std::uint32_t>(indices.size()), 0, 0, range});
    }
    clusters.finish();
    scene::SceneState state{*city};
    state.set_time(0.0);
    const PlacedInstances placed{*city, state};
    Culling culling{placed, {}};
    Camera camera = test::plain_camera({256, 256});
    TaskPool two{2};
    TaskPool five{5};
    DrawList alone{placed};
    DrawList shared{placed};
    for (int step = 0; step < 8; ++step) {
        camera.world_from_eye = city->start_pose.value_or(Pose{});
        camera.world_from_eye.orientation =
            glm::angleAxis(0.8 * step, glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
        const std::vector<std::uint32_t>& visible = culling.visible(camera);
        alone.build(visible, camera, batches, {&clusters, culling.cluster_view(camera)});
        EXPECT_GT(alone.cluster_counters().tested, 100U);
        for (TaskPool* pool : {&two, &five}) {
            shared.build(visible, camera, batches, {&clusters, culling.cluster_view(camera), pool});
            EXPECT_TRUE(std::ranges::equal(shared.commands(), alone.commands(), same_command)) << step;
            EXPECT_EQ(shared.cluster_counters().occluded, alone.cluster_counters().occluded);
            EXPECT_EQ(shared.cluster_counters().turned_away, alone.cluster_counters().turned_away);
        }
    }
}

TEST(DrawListThreads, AnyNumberOfThreadsFindsTheSameObjects) {
    auto city = scene::make_built_in("city", {{"buildings", 60.0}});
    ASSERT_TRUE(city.ok());
    scene::SceneState state{*city};
    state.set_time(0.0);
    PlacedInstances placed{*city, state};
    TaskPool three{3};
    Culling alone{placed, {}};
    Culling shared{placed, {}, &three};
    Camera camera = test::plain_camera({256, 256});
    for (int step = 0; step < 8; ++step) {
        camera.world_from_eye = city->start_pose.value_or(Pose{});
        camera.world_from_eye.orientation =
            glm::angleAxis(0.8 * step, glm::dvec3{0.0, 1.0, 0.0}) * camera.world_from_eye.orientation;
        state.set_time(0.5 * step);
        placed.move(state);
        alone.move();
        shared.move();
        const std::vector<std::uint32_t>& expected = alone.visible(camera);
        EXPECT_GT(alone.counters().occluders, 0U);
        EXPECT_EQ(shared.visible(camera), expected) << step;
        EXPECT_EQ(shared.counters().occluded, alone.counters().occluded);
        EXPECT_EQ(shared.counters().outside, alone.counters().outside);
        EXPECT_EQ(shared.counters().between_samples, alone.counters().between_samples);
    }
}

}  // namespace
}  // namespace lw
