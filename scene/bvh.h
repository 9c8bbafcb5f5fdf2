#pragma once
/// A hierarchy of boxes over the instances of a scene (or over anything else that has boxes).

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/scene.h"

namespace lw::scene {

/// Half a cache line. Inner nodes have two children that lie side by side, so a pair fills one line.
struct alignas(32) BvhNode {
    glm::vec3 min{0.0F};
    std::uint32_t first = 0;  ///< inner: index of the first child; leaf: of its first item in order()
    glm::vec3 max{0.0F};
    std::uint32_t count = 0;  ///< items of a leaf; 0: inner node
};
static_assert(sizeof(BvhNode) == 32);

/// Built once by the surface-area heuristic, then refitted when items move. Items of any subtree are neighbours in
/// order(). Boxes are rounded outwards to single precision. Changes are for one thread at a time.
class Bvh {
public:
    static constexpr std::uint32_t kRoot = 0;
    static constexpr std::uint32_t kNone = 0xFFFFFFFFU;

    /// `boxes[i]` belongs to item i; empty boxes are left out. At most `leaf_size` items per leaf, unless splitting
    /// them costs more than testing them all. O(n log n).
    explicit Bvh(std::span<const Bounds> boxes, std::uint32_t leaf_size = 16);

    [[nodiscard]] bool empty() const { return nodes_.empty(); }
    [[nodiscard]] const std::vector<BvhNode>& nodes() const { return nodes_; }
    /// Items, leaf by leaf.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
    /// The items of a node's subtree: a range of order().
    [[nodiscard]] std::uint32_t first_item(std::uint32_t node) const { return items_[node].first; }
    [[nodiscard]] std::uint32_t end_item(std::uint32_t node) const { return items_[node].end; }
    [[nodiscard]] std::uint32_t parent(std::uint32_t node) const { return parents_[node]; }
    [[nodiscard]] std::uint32_t leaf_of(std::uint32_t item) const { return leaves_[item]; }
    /// Where an item stands in order(), kNone for one left out.
    [[nodiscard]] std::uint32_t place_of(std::uint32_t item) const { return places_[item]; }

    /// Fits the boxes of the leaves that hold `moved` items and of the nodes above them; `boxes` are those of all
    /// items. A box that is empty now keeps its old place. The tree keeps its shape: what moves far makes it slower,
    /// not wrong.
    void refit(std::span<const std::uint32_t> moved, std::span<const Bounds> boxes);

private:
    struct Builder;
    struct ItemRange {
        std::uint32_t first = 0;
        std::uint32_t end = 0;
    };
    [[nodiscard]] bool fit(std::uint32_t node, std::span<const Bounds> boxes);

    std::vector<BvhNode> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint32_t> parents_;
    std::vector<ItemRange> items_;  ///< by node
    std::vector<std::uint32_t> places_;
    std::vector<std::uint32_t> leaves_;  ///< by item
};

}  // namespace lw::scene
