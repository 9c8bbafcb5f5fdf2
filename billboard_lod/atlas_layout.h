#pragma once
/// How slots of one dimension lie in framebuffers (seed 000, sections 3.2 and 3.4.1), and which of them are taken.

#include <array>
#include <compare>
#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "billboard_lod/billboard_plane.h"

namespace lw {

/// Slots of `dimension` texels a side, column by column in rows from the top, on pages of equal size one after another.
struct AtlasLayout {
    int dimension = 0;
    int columns = 0;  ///< 0: no slot fits
    int rows = 0;
    int pages = 0;
    int capacity = 0;  ///< slots of all pages: at least as many as wanted where the limits allow

    /// Of a page.
    [[nodiscard]] glm::ivec2 size_px() const { return {columns * dimension, rows * dimension}; }
    /// Page of slot `index` in [0, capacity).
    [[nodiscard]] int page_of(int index) const { return index / (columns * rows); }
    /// First texel of a slot on its page.
    [[nodiscard]] glm::ivec2 slot_origin_px(int index) const {
        const int on_page = index % (columns * rows);
        return {on_page % columns * dimension, on_page / columns * dimension};
    }
    /// T: left, top, right, bottom of a slot as texture coordinates of its page.
    [[nodiscard]] glm::dvec4 slot_uv(int index) const {
        const glm::dvec2 low = glm::dvec2{slot_origin_px(index)} / glm::dvec2{size_px()};
        const glm::dvec2 high = glm::dvec2{slot_origin_px(index) + dimension} / glm::dvec2{size_px()};
        return {low, high};
    }
};

/// One page: F_W = min(B_T, a) and F_H = min(B_D * ceil(B_T / F_W), b) with B_T = B_D * wanted and the limits a, b
/// rounded down to powers of two. No columns when `wanted` < 1 or a limit is below one slot. Pure.
[[nodiscard]] AtlasLayout atlas_layout(int dimension, int wanted, glm::ivec2 limit_px);

/// As many pages of at most `page_texels` as `wanted` slots take, at least one slot on each. Pure.
[[nodiscard]] AtlasLayout paged_layout(int dimension, int wanted, glm::ivec2 limit_px, int page_texels);

/// A page of the atlas of kBillboardDimensions[level].
struct AtlasPage {
    std::size_t level = 0;
    int index = 0;

    friend auto operator<=>(const AtlasPage&, const AtlasPage&) = default;
};

/// A slot in the atlas of kBillboardDimensions[level].
struct AtlasSlot {
    std::size_t level = 0;
    int index = 0;

    friend bool operator==(const AtlasSlot&, const AtlasSlot&) = default;
};

using AtlasLayouts = std::array<AtlasLayout, kBillboardDimensions.size()>;

/// `slot` is one of `layouts`. Pure.
[[nodiscard]] inline AtlasPage page_of(const AtlasLayouts& layouts, AtlasSlot slot) {
    return {slot.level, layouts[slot.level].page_of(slot.index)};
}

/// Which slots are free. One thread at a time.
class SlotTable {
public:
    explicit SlotTable(const AtlasLayouts& layouts);

    /// A free slot of the wanted level, else of a larger one, else of a smaller one (the next in size first), of a
    /// level the first one: as few pages as possible are used. Nothing when all are taken.
    [[nodiscard]] std::optional<AtlasSlot> reserve(std::size_t level);
    /// `slot` was reserved.
    void release(AtlasSlot slot);
    [[nodiscard]] std::size_t free_count(std::size_t level) const { return free_[level].size(); }

private:
    std::array<std::vector<int>, kBillboardDimensions.size()> free_;  ///< descending
};

}  // namespace lw
