#include "client_renderer/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/client_renderer/hand_made_scenes.h"

namespace lw {
namespace {

std::vector<scene::Bounds> random_boxes(std::mt19937& random, std::size_t count) {
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    std::vector<scene::Bounds> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 centre = 50.0 * glm::dvec3{unit(random), unit(random), unit(random)};
        const glm::dvec3 half{1.0 + unit(random), 1.0 + unit(random), 1.0 + unit(random)};
        boxes.push_back({centre - half, centre + half});
    }
    return boxes;
}

Camera random_camera(std::mt19937& random) {
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    Camera camera = test::plain_camera({256, 256});
    camera.world_from_eye.position_m = 30.0 * glm::dvec3{unit(random), unit(random), unit(random)};
    camera.world_from_eye.orientation =
        glm::normalize(glm::dquat{unit(random), unit(random), unit(random), unit(random)});
    return camera;
}

std::vector<std::uint32_t> by_list(const std::vector<scene::Bounds>& boxes, const Camera& camera) {
    BoxList list;
    list.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) list.set(i, boxes[i]);
    std::vector<std::uint32_t> seen;
    list.append_seen(frustum_of(camera), seen);
    return seen;
}

std::vector<std::uint32_t> by_tree(BoxTree& tree, const Camera& camera) {
    WalkQuery query;
    query.frustum = rounded(frustum_of(camera));
    std::vector<std::uint32_t> seen;
    tree.append_seen(query, seen);
    std::ranges::sort(seen);
    return seen;
}

TEST(BoxTree, SeesWhatTheListSees) {
    std::mt19937 random{1};
    for (const std::size_t count : {1U, 2U, 15U, 16U, 17U, 63U, 64U, 1000U}) {
        const std::vector<scene::Bounds> boxes = random_boxes(random, count);
        BoxTree tree{boxes};
        for (int i = 0; i < 20; ++i) {
            const Camera camera = random_camera(random);
            const std::vector<std::uint32_t> seen = by_tree(tree, camera);
            EXPECT_EQ(seen, by_list(boxes, camera)) << count << " boxes, view " << i;
            EXPECT_EQ(tree.counters().items_outside + seen.size(), count);
        }
    }
}

TEST(BoxTree, TheListSeesWhatMaySeeSees) {
    std::mt19937 random{2};
    std::vector<scene::Bounds> boxes = random_boxes(random, 500);
    boxes[7] = {};
    for (int i = 0; i < 20; ++i) {
        const Camera camera = random_camera(random);
        const Frustum frustum = frustum_of(camera);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t k = 0; k < boxes.size(); ++k) {
            if (may_see(frustum, boxes[k])) expected.push_back(k);
        }
        EXPECT_EQ(by_list(boxes, camera), expected);
    }
}

TEST(BoxTree, FollowsWhatMoves) {
    std::mt19937 random{3};
    std::vector<scene::Bounds> boxes = random_boxes(random, 700);
    BoxTree tree{boxes};
    std::uniform_int_distribution<std::uint32_t> any{0, 699};
    for (int round = 0; round < 20; ++round) {
        std::vector<std::uint32_t> moved;
        for (int i = 0; i < 40; ++i) moved.push_back(any(random));
        const std::vector<scene::Bounds> places = random_boxes(random, moved.size());
        for (std::size_t i = 0; i < moved.size(); ++i) boxes[moved[i]] = places[i];
        tree.move(moved, boxes);
        const Camera camera = random_camera(random);
        EXPECT_EQ(by_tree(tree, camera), by_list(boxes, camera));
    }
}

TEST(BoxTree, SeveralFrustaInOneWalkSeeWhatEachSees) {
    std::mt19937 random{4};
    const std::vector<scene::Bounds> boxes = random_boxes(random, 900);
    BoxTree tree{boxes};
    for (int round = 0; round < 10; ++round) {
        std::vector<Camera> cameras;
        std::vector<Frustum> frusta;
        for (int i = 0; i < 6; ++i) {
            cameras.push_back(random_camera(random));
            frusta.push_back(frustum_of(cameras.back()));
        }
        std::vector<SeenItem> seen;
        tree.append_seen(frusta, seen);
        for (std::size_t f = 0; f < frusta.size(); ++f) {
            std::vector<std::uint32_t> by_this;
            for (const SeenItem& item : seen) {
                if ((item.frusta >> f & 1U) != 0) by_this.push_back(item.item);
            }
            std::ranges::sort(by_this);
            EXPECT_EQ(by_this, by_list(boxes, cameras[f]));
        }
        std::vector<std::uint32_t> items;
        for (const SeenItem& item : seen) {
            EXPECT_NE(item.frusta, 0U);
            items.push_back(item.item);
        }
        std::ranges::sort(items);
        EXPECT_EQ(std::ranges::adjacent_find(items), items.end()) << "an item came twice";
    }
}

TEST(BoxTree, HiddenSubtreesAreHiddenItemByItem) {
    std::mt19937 random{5};
    const std::vector<scene::Bounds> boxes = random_boxes(random, 2000);
    BoxTree tree{boxes};
    BoxList list;
    list.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) list.set(i, boxes[i]);
    std::uint64_t hidden_count = 0;
    for (int round = 0; round < 10; ++round) {
        const Camera camera = random_camera(random);
        OcclusionBuffer buffer;
        buffer.begin(camera);
        for (const scene::Bounds& small : random_boxes(random, 40)) {
            // Large enough to hide something.
            const scene::Bounds wall{small.centre() - 8.0 * small.half_size(),
                                     small.centre() + 8.0 * small.half_size()};
            ConvexSolid solid;
            for (int side = 0; side < 6; ++side) {
                const bool upper = side % 2 == 1;
                glm::dvec3 normal{0.0};
                normal[side / 2] = upper ? 1.0 : -1.0;
                const double offset = upper ? wall.max[side / 2] : -wall.min[side / 2];
                solid.planes_world[static_cast<std::size_t>(side)] = {normal, offset};
            }
            buffer.add(solid);
        }
        const std::vector<std::uint32_t> in_view = by_list(boxes, camera);
        std::vector<std::uint32_t> seen_by_list;
        hidden_count += buffer.split(list, in_view, seen_by_list).hidden;
        WalkQuery query;
        query.frustum = rounded(frustum_of(camera));
        query.occlusion = &buffer;
        std::vector<std::uint32_t> seen;
        tree.append_seen(query, seen);
        std::ranges::sort(seen);
        // A node's box is larger than those in it: whatever a hidden node holds is hidden by itself too.
        EXPECT_EQ(seen, seen_by_list);
    }
    EXPECT_GT(hidden_count, 100U);
}

TEST(BoxTree, AnyNumberOfThreadsSeesTheSame) {
    std::mt19937 random{6};
    const std::vector<scene::Bounds> boxes = random_boxes(random, 20000);
    BoxTree tree{boxes};
    TaskPool two{2};
    TaskPool five{5};
    for (int round = 0; round < 10; ++round) {
        const Camera camera = random_camera(random);
        OcclusionBuffer buffer;
        buffer.begin(camera);
        WalkQuery query;
        query.frustum = rounded(frustum_of(camera));
        query.occlusion = &buffer;
        query.least_size_per_distance = 0.04F;
        std::vector<std::uint32_t> alone{7};
        tree.append_seen(query, alone);
        const WalkCounters expected = tree.counters();
        EXPECT_GT(expected.items_too_small, 0U);
        std::ranges::sort(alone);
        for (TaskPool* pool : {&two, &five}) {
            std::vector<std::uint32_t> shared{7};  // it appends
            tree.append_seen(query, shared, pool);
            std::ranges::sort(shared);
            EXPECT_EQ(shared, alone);
            EXPECT_EQ(tree.counters(), expected);
        }
    }
}

}  // namespace
}  // namespace lw
