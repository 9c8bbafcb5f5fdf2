#include "billboard_lod/atlas_layout.h"

#include <gtest/gtest.h>

#include <set>

#include "billboard_lod/bounded_queue.h"

namespace lw {
namespace {

TEST(AtlasLayout, OneRowWhereItFits) {
    const AtlasLayout layout = atlas_layout(16, 512, {16384, 16384});
    EXPECT_EQ(layout.size_px(), glm::ivec2(8192, 16));
    EXPECT_EQ(layout.capacity, 512);
}

TEST(AtlasLayout, RowsWhereTheWidthEnds) {
    // B_T = 256 * 512 = 131072 = 8 rows of 16384.
    const AtlasLayout layout = atlas_layout(256, 512, {16384, 16384});
    EXPECT_EQ(layout.size_px(), glm::ivec2(16384, 2048));
    EXPECT_EQ(layout.columns, 64);
    EXPECT_EQ(layout.rows, 8);
}

TEST(AtlasLayout, LimitsAreRoundedDownToPowersOfTwo) {
    EXPECT_EQ(atlas_layout(64, 512, {10000, 10000}).size_px(), glm::ivec2(8192, 256));
}

TEST(AtlasLayout, AnIncompleteRowIsFilledUp) {
    const AtlasLayout layout = atlas_layout(512, 3, {1024, 4096});
    EXPECT_EQ(layout.size_px(), glm::ivec2(1024, 1024));
    EXPECT_EQ(layout.capacity, 4);
}

TEST(AtlasLayout, TheHeightLimitCostsSlots) {
    const AtlasLayout layout = atlas_layout(512, 128, {2048, 2048});
    EXPECT_EQ(layout.capacity, 16);
}

TEST(AtlasLayout, NothingFitsBelowOneSlot) {
    EXPECT_EQ(atlas_layout(512, 128, {256, 16384}).capacity, 0);
    EXPECT_EQ(atlas_layout(512, 128, {16384, 511}).capacity, 0);
    EXPECT_EQ(atlas_layout(16, 0, {16384, 16384}).capacity, 0);
    EXPECT_EQ(atlas_layout(16, -3, {16384, 16384}).capacity, 0);
}

TEST(AtlasLayout, ViewportsAndTextureCoordinatesOfASlot) {
    const AtlasLayout layout = atlas_layout(64, 8, {256, 256});  // 4 columns, 2 rows
    EXPECT_EQ(layout.slot_origin_px(0), glm::ivec2(0, 0));
    EXPECT_EQ(layout.slot_origin_px(6), glm::ivec2(128, 64));
    const glm::dvec4 uv = layout.slot_uv(6);
    EXPECT_EQ(uv, glm::dvec4(0.5, 0.5, 0.75, 1.0));
}

TEST(AtlasLayout, PagesHoldAtMostTheirTexels) {
    const AtlasLayout layout = paged_layout(256, 20, {16384, 16384}, 1 << 19);  // eight slots of 65536 texels
    EXPECT_EQ(layout.size_px(), glm::ivec2(2048, 256));
    EXPECT_EQ(layout.pages, 3);
    EXPECT_EQ(layout.capacity, 24) << "the last page is whole";
    EXPECT_EQ(layout.page_of(7), 0);
    EXPECT_EQ(layout.page_of(8), 1);
    EXPECT_EQ(layout.slot_origin_px(19), glm::ivec2(3 * 256, 0)) << "the fourth of the third page";
}

TEST(AtlasLayout, FewSlotsTakeNoMoreThanTheyNeed) {
    const AtlasLayout layout = paged_layout(64, 8, {256, 256}, 1 << 19);
    EXPECT_EQ(layout.size_px(), glm::ivec2(256, 128));
    EXPECT_EQ(layout.pages, 1);
    EXPECT_EQ(layout.capacity, 8);
}

TEST(AtlasLayout, ALimitBelowAPageMakesMorePages) {
    const AtlasLayout layout = paged_layout(512, 8, {512, 1024}, 1 << 22);  // two slots where sixteen were allowed
    EXPECT_EQ(layout.pages, 4);
    EXPECT_EQ(layout.capacity, 8);
}

TEST(AtlasLayout, AtLeastOneSlotIsOnAPageAndNoneWhereNoneFits) {
    EXPECT_EQ(paged_layout(512, 3, {16384, 16384}, 1).pages, 3);
    EXPECT_EQ(paged_layout(512, 3, {256, 16384}, 1 << 19).capacity, 0);
    EXPECT_EQ(paged_layout(512, 0, {16384, 16384}, 1 << 19).capacity, 0);
    EXPECT_EQ(paged_layout(512, -1, {16384, 16384}, 1 << 19).pages, 0);
}

AtlasLayouts small_layouts() {
    AtlasLayouts layouts;
    for (std::size_t level = 0; level < layouts.size(); ++level) {
        layouts[level] = atlas_layout(kBillboardDimensions[level], level == 4 ? 0 : 1, {16384, 16384});
    }
    return layouts;
}

TEST(SlotTable, WantedThenLargerThenSmaller) {
    SlotTable table{small_layouts()};
    EXPECT_EQ(table.reserve(2)->level, 2U);
    EXPECT_EQ(table.reserve(2)->level, 3U);
    EXPECT_EQ(table.reserve(2)->level, 5U) << "level 4 has no slots";
    EXPECT_EQ(table.reserve(2)->level, 1U);
    EXPECT_EQ(table.reserve(2)->level, 0U);
    EXPECT_FALSE(table.reserve(2).has_value()) << "all full";
}

TEST(SlotTable, AReleasedSlotComesBack) {
    SlotTable table{small_layouts()};
    const AtlasSlot slot = *table.reserve(0);
    EXPECT_EQ(table.free_count(0), 0U);
    table.release(slot);
    EXPECT_EQ(table.free_count(0), 1U);
    EXPECT_EQ(*table.reserve(0), slot);
}

TEST(SlotTable, TheFirstFreeSlotIsTaken) {
    AtlasLayouts layouts;
    layouts[0] = paged_layout(16, 4, {16384, 16384}, 2 * 16 * 16);  // two pages
    SlotTable table{layouts};
    for (int index = 0; index < 4; ++index) EXPECT_EQ(table.reserve(0)->index, index);
    table.release({0, 1});
    table.release({0, 3});
    table.release({0, 0});
    for (const int index : {0, 1, 3}) EXPECT_EQ(table.reserve(0)->index, index);
}

TEST(SlotTable, WithoutCapacityThereIsNothing) {
    SlotTable table{AtlasLayouts{}};
    for (std::size_t level = 0; level < kBillboardDimensions.size(); ++level) EXPECT_FALSE(table.reserve(level));
}

TEST(BoundedQueue, KeepsTheBestAndHandsBackWhatFallsOut) {
    BoundedQueue<int> queue{2};
    EXPECT_FALSE(queue.push(1.0, 10));
    EXPECT_FALSE(queue.push(3.0, 30));
    EXPECT_EQ(queue.push(2.0, 20), 10) << "the lowest is displaced";
    EXPECT_EQ(queue.push(0.5, 5), 5) << "too low to enter";
    EXPECT_EQ(queue.push(2.0, 21), 21) << "equal: the earlier one stays";
    std::vector<int> kept;
    queue.drain(kept);
    EXPECT_EQ(kept, (std::vector<int>{30, 20}));
    queue.drain(kept);
    EXPECT_TRUE(kept.empty());
}

TEST(BoundedQueue, OfNoLengthKeepsNothing) {
    BoundedQueue<int> queue{0};
    EXPECT_EQ(queue.push(9.0, 1), 1);
}

}  // namespace
}  // namespace lw
