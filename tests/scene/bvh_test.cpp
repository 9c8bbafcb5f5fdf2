#include "scene/bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "scene/random.h"

namespace lw::scene {
namespace {

std::vector<Bounds> random_boxes(std::size_t count) {
    Random random{5};
    std::vector<Bounds> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 at{random.between(-9.0, 9.0), random.between(-9.0, 9.0), random.between(-9.0, 9.0)};
        boxes.push_back({at, at + glm::dvec3{random.unit(), random.unit(), random.unit()}});
    }
    return boxes;
}

bool holds(const BvhNode& node, const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
        if (double{node.min[axis]} > box.min[axis] || double{node.max[axis]} < box.max[axis]) return false;
    }
    return true;
}

/// Every node holds the boxes of its items, children divide their parent's items, every item is in one leaf.
void expect_sound(const Bvh& bvh, const std::vector<Bounds>& boxes) {
    std::vector<int> times(boxes.size(), 0);
    for (std::uint32_t node = 0; node < bvh.nodes().size(); ++node) {
        const BvhNode& here = bvh.nodes()[node];
        for (std::uint32_t i = bvh.first_item(node); i < bvh.end_item(node); ++i) {
            EXPECT_TRUE(holds(here, boxes[bvh.order()[i]])) << "node " << node;
            if (here.count > 0) ++times[bvh.order()[i]];
        }
        if (here.count > 0) continue;
        EXPECT_EQ(bvh.first_item(here.first), bvh.first_item(node));
        EXPECT_EQ(bvh.end_item(here.first), bvh.first_item(here.first + 1));
        EXPECT_EQ(bvh.end_item(here.first + 1), bvh.end_item(node));
        EXPECT_EQ(bvh.parent(here.first), node);
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) EXPECT_EQ(times[i], boxes[i].empty() ? 0 : 1) << "item " << i;
}

TEST(Bvh, HoldsEveryItemOnce) {
    for (const std::size_t count : {0U, 1U, 2U, 17U, 500U}) {
        const std::vector<Bounds> boxes = random_boxes(count);
        const Bvh bvh{boxes, 4};
        expect_sound(bvh, boxes);
        for (const BvhNode& node : bvh.nodes()) EXPECT_LE(node.count, 4U);
    }
}

TEST(Bvh, LeavesOutEmptyBoxesAndTakesEqualOnes) {
    std::vector<Bounds> boxes(40, Bounds{glm::dvec3{1.0}, glm::dvec3{2.0}});
    boxes[3] = {};
    const Bvh bvh{boxes, 4};
    expect_sound(bvh, boxes);
    EXPECT_EQ(bvh.order().size(), 39U);
}

TEST(Bvh, RefittingFollowsWhatMoves) {
    std::vector<Bounds> boxes = random_boxes(300);
    Bvh bvh{boxes, 4};
    Random random{6};
    for (int round = 0; round < 20; ++round) {
        std::vector<std::uint32_t> moved;
        for (int i = 0; i < 10; ++i) {
            const auto item = static_cast<std::uint32_t>(random.below(300));
            const glm::dvec3 step{random.between(-5.0, 5.0), 0.0, random.between(-5.0, 5.0)};
            boxes[item] = {boxes[item].min + step, boxes[item].max + step};
            moved.push_back(item);
        }
        bvh.refit(moved, boxes);
        expect_sound(bvh, boxes);
    }
}

TEST(Bvh, ClustersGetNodesOfTheirOwn) {
    // Two heaps far apart: the first split separates them, whatever their sizes.
    std::vector<Bounds> boxes = random_boxes(100);
    for (std::size_t i = 70; i < 100; ++i) {
        boxes[i].min.x += 1000.0;
        boxes[i].max.x += 1000.0;
    }
    const Bvh bvh{boxes, 4};
    const BvhNode& root = bvh.nodes()[Bvh::kRoot];
    ASSERT_EQ(root.count, 0U);
    EXPECT_EQ(bvh.end_item(root.first) - bvh.first_item(root.first), 70U);
}

}  // namespace
}  // namespace lw::scene
