#include "billboard_lod/atlas_layout.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <functional>

#include "core/check.h"

namespace lw {

AtlasLayout atlas_layout(int dimension, int wanted, glm::ivec2 limit_px) {
    AtlasLayout layout;
    layout.dimension = dimension;
    if (wanted < 1 || limit_px.x < dimension || limit_px.y < dimension) return layout;
    const auto power_of_two = [](int limit) {
        return static_cast<std::int64_t>(std::bit_floor(static_cast<std::uint32_t>(limit)));
    };
    const std::int64_t total = std::int64_t{dimension} * wanted;
    const std::int64_t width = std::min(total, power_of_two(limit_px.x));
    const std::int64_t height = std::min(dimension * ((total + width - 1) / width), power_of_two(limit_px.y));
    layout.columns = static_cast<int>(width / dimension);
    layout.rows = static_cast<int>(height / dimension);
    layout.pages = 1;
    layout.capacity = layout.columns * layout.rows;
    return layout;
}

AtlasLayout paged_layout(int dimension, int wanted, glm::ivec2 limit_px, int page_texels) {
    const int on_page = std::clamp(page_texels / (dimension * dimension), 1, std::max(wanted, 1));
    AtlasLayout layout = atlas_layout(dimension, std::min(wanted, on_page), limit_px);
    if (layout.pages == 0) return layout;
    layout.pages = (wanted + layout.capacity - 1) / layout.capacity;
    layout.capacity *= layout.pages;
    return layout;
}

SlotTable::SlotTable(const AtlasLayouts& layouts) {
    for (std::size_t level = 0; level < layouts.size(); ++level) {
        for (int index = layouts[level].capacity - 1; index >= 0; --index) free_[level].push_back(index);
    }
}

std::optional<AtlasSlot> SlotTable::reserve(std::size_t level) {
    const auto take = [&](std::size_t from) -> std::optional<AtlasSlot> {
        if (free_[from].empty()) return std::nullopt;
        const AtlasSlot slot{from, free_[from].back()};
        free_[from].pop_back();
        return slot;
    };
    for (std::size_t larger = level; larger < free_.size(); ++larger) {
        if (const auto slot = take(larger)) return slot;
    }
    for (std::size_t smaller = level; smaller-- > 0;) {
        if (const auto slot = take(smaller)) return slot;
    }
    return std::nullopt;
}

void SlotTable::release(AtlasSlot slot) {
    LW_CHECK(slot.level < free_.size(), "a slot of no level");
    std::vector<int>& free = free_[slot.level];
    free.insert(std::ranges::lower_bound(free, slot.index, std::greater{}), slot.index);
}

}  // namespace lw
