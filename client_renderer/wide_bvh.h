#pragma once
/// A hierarchy with up to sixteen children per node, side by side: one wide vector tests them all.

#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/box_list.h"
#include "scene/bvh.h"

namespace lw {

/// Made of a hierarchy with two children per node by taking the place of nodes with their children, the largest first,
/// while there is room. Changes are for one thread at a time.
class WideBvh {
public:
    static constexpr std::size_t kMostChildren = 16;  ///< more only where items cannot be told apart

    /// What stands in a slot: an item, or a node with its own run of slots.
    struct Child {
        std::uint32_t first = 0;       ///< the item, or the node's first slot
        std::uint32_t slot_count = 0;  ///< 0: an item
        [[nodiscard]] bool is_item() const { return slot_count == 0; }
    };

    /// @param boxes  of the items, as `bvh` was built from them
    WideBvh(const scene::Bvh& bvh, std::span<const scene::Bounds> boxes);

    /// After `bvh` was refitted to items that moved.
    void move(const scene::Bvh& bvh, std::span<const std::uint32_t> moved, std::span<const scene::Bounds> boxes);

    [[nodiscard]] Child root() const { return root_; }
    /// By slot. A vector may begin at any.
    [[nodiscard]] const BoxList& boxes() const { return boxes_; }
    [[nodiscard]] const Child* children() const { return children_.data(); }
    /// By slot: how many items there are, and where in the hierarchy's order.
    [[nodiscard]] const std::uint32_t* item_counts() const { return item_counts_.data(); }
    [[nodiscard]] std::uint32_t first_item(std::uint32_t slot) const { return first_items_[slot]; }

private:
    struct Builder;

    Child root_;
    BoxList boxes_;
    std::vector<Child> children_;
    std::vector<std::uint32_t> item_counts_;
    std::vector<std::uint32_t> first_items_;
    std::vector<std::uint32_t> slots_of_items_;
    std::vector<std::uint32_t> slots_of_nodes_;  ///< kNone: the node's children took its place
};

}  // namespace lw
