#include "client_renderer/wide_bvh.h"

#include <algorithm>

#include "client_renderer/fetch_lines.h"

namespace lw {

namespace {

constexpr std::uint32_t kNone = scene::Bvh::kNone;

float half_area(const scene::BvhNode& node) {
    const glm::vec3 size = node.max - node.min;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

scene::Bounds bounds_of(const scene::BvhNode& node) { return {glm::dvec3{node.min}, glm::dvec3{node.max}}; }

}  // namespace

struct WideBvh::Builder {
    const scene::Bvh& bvh;
    std::span<const scene::Bounds> boxes;
    WideBvh& wide;

    /// A node of `bvh`, or an item.
    struct Entry {
        std::uint32_t index = 0;
        bool is_item = false;
    };

    void append_inside(std::uint32_t node, std::vector<Entry>& entries) const {
        const scene::BvhNode& here = bvh.nodes()[node];
        if (here.count == 0) {
            entries.push_back({here.first, false});
            entries.push_back({here.first + 1, false});
            return;
        }
        for (std::uint32_t i = 0; i < here.count; ++i) entries.push_back({bvh.order()[here.first + i], true});
    }

    /// The largest node whose inside has room in its place, or the end.
    std::vector<Entry>::iterator next_to_open(std::vector<Entry>& entries) const {
        auto largest = entries.end();
        float largest_area = -1.0F;
        for (auto entry = entries.begin(); entry != entries.end(); ++entry) {
            if (entry->is_item) continue;
            const scene::BvhNode& node = bvh.nodes()[entry->index];
            const std::size_t inside = node.count == 0 ? 2 : node.count;
            if (entries.size() + inside - 1 > kMostChildren || half_area(node) <= largest_area) continue;
            largest = entry;
            largest_area = half_area(node);
        }
        return largest;
    }

    Child build(std::uint32_t node) {
        std::vector<Entry> entries;
        append_inside(node, entries);
        for (auto open = next_to_open(entries); open != entries.end(); open = next_to_open(entries)) {
            const std::uint32_t opened = open->index;
            entries.erase(open);
            append_inside(opened, entries);
        }
        const Child run{static_cast<std::uint32_t>(wide.slot_count()), static_cast<std::uint32_t>(entries.size())};
        wide.blocks_.resize(wide.blocks_.size() + (entries.size() + kMostChildren - 1) / kMostChildren);
        wide.first_items_.resize(wide.slot_count(), 0);
        for (std::uint32_t i = 0; i < run.slot_count; ++i) fill(run.first + i, entries[i]);
        return run;
    }

    void fill(std::uint32_t slot, const Entry& entry) {
        if (entry.is_item) {
            put(slot, {entry.index, 0}, 1);
            wide.slots_of_items_[entry.index] = slot;
            wide.set_box(slot, boxes[entry.index]);
            return;
        }
        wide.slots_of_nodes_[entry.index] = slot;
        wide.set_box(slot, bounds_of(bvh.nodes()[entry.index]));
        wide.first_items_[slot] = bvh.first_item(entry.index);
        const Child inside = build(entry.index);  // may move the blocks
        put(slot, inside, bvh.end_item(entry.index) - bvh.first_item(entry.index));
    }

    void put(std::uint32_t slot, const Child& child, std::uint32_t item_count) const {
        Block& block = wide.blocks_[slot / kMostChildren];
        block.children[slot % kMostChildren] = child;
        block.item_counts[slot % kMostChildren] = item_count;
    }
};

WideBvh::WideBvh(const scene::Bvh& bvh, std::span<const scene::Bounds> boxes)
    : slots_of_items_(boxes.size(), kNone), slots_of_nodes_(bvh.nodes().size(), kNone) {
    if (bvh.empty()) return;
    Builder builder{bvh, boxes, *this};
    root_ = builder.build(scene::Bvh::kRoot);
}

void WideBvh::fetch(const Child& node) const {
    const std::size_t count = (node.slot_count + kMostChildren - 1) / kMostChildren;
    for (std::size_t i = 0; i < count; ++i) fetch_lines(&block(node.first) + i);
}

void WideBvh::move(const scene::Bvh& bvh, std::span<const std::uint32_t> moved, std::span<const scene::Bounds> boxes) {
    for (const std::uint32_t item : moved) {
        const std::uint32_t slot = slots_of_items_[item];
        if (slot == kNone) continue;
        set_box(slot, boxes[item]);
        for (std::uint32_t node = bvh.leaf_of(item); node != kNone; node = bvh.parent(node)) {
            if (slots_of_nodes_[node] == kNone) continue;
            // A node that does not change leaves those above it as they are.
            if (!set_box(slots_of_nodes_[node], bounds_of(bvh.nodes()[node]))) break;
        }
    }
}

}  // namespace lw
