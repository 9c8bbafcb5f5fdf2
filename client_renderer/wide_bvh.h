#pragma once
/// A hierarchy with up to sixteen children per node, side by side: one wide vector tests them all.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client_renderer/box_block.h"
#include "scene/bvh.h"

namespace lw {

/// Made of a hierarchy with two children per node by taking the place of nodes with their children, the largest first,
/// while there is room. Changes are for one thread at a time.
class WideBvh {
public:
    static constexpr std::size_t kMostChildren = BoxBlock::kBoxes;  ///< more only where items cannot be told apart

    /// What stands in a slot: an item, or a node with its own run of slots.
    struct Child {
        std::uint32_t first = 0;       ///< the item, or the node's first slot
        std::uint32_t slot_count = 0;  ///< 0: an item
        [[nodiscard]] bool is_item() const { return slot_count == 0; }
    };

    /// Up to sixteen slots next to each other, in cache lines that follow each other: what a node's test reads.
    struct Block {
        BoxBlock boxes;
        std::array<Child, kMostChildren> children{};
        std::array<std::uint32_t, kMostChildren> item_counts{};
    };

    /// @param boxes  of the items, as `bvh` was built from them
    WideBvh(const scene::Bvh& bvh, std::span<const scene::Bounds> boxes);

    /// After `bvh` was refitted to items that moved.
    void move(const scene::Bvh& bvh, std::span<const std::uint32_t> moved, std::span<const scene::Bounds> boxes);

    [[nodiscard]] Child root() const { return root_; }
    /// A node's run of slots begins with a block.
    [[nodiscard]] std::size_t slot_count() const { return kMostChildren * blocks_.size(); }
    [[nodiscard]] const Block& block(std::uint32_t slot) const { return blocks_[slot / kMostChildren]; }
    [[nodiscard]] const Child& child(std::uint32_t slot) const { return block(slot).children[slot % kMostChildren]; }
    /// How many items there are in a slot, and where in the hierarchy's order.
    [[nodiscard]] std::uint32_t item_count(std::uint32_t slot) const {
        return block(slot).item_counts[slot % kMostChildren];
    }
    [[nodiscard]] std::uint32_t first_item(std::uint32_t slot) const { return first_items_[slot]; }
    /// Asks for what a test of the node reads.
    void fetch(const Child& node) const;

private:
    struct Builder;

    bool set_box(std::uint32_t slot, const scene::Bounds& bounds) {
        return blocks_[slot / kMostChildren].boxes.set(slot % kMostChildren, bounds);
    }

    Child root_;
    std::vector<Block> blocks_;
    std::vector<std::uint32_t> first_items_;
    std::vector<std::uint32_t> slots_of_items_;
    std::vector<std::uint32_t> slots_of_nodes_;  ///< kNone: the node's children took its place
};

}  // namespace lw
