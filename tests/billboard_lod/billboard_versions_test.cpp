#include "billboard_lod/billboard_versions.h"

#include <gtest/gtest.h>

namespace lw {
namespace {

/// Two slots of 16 texels and one of 32.
AtlasLayouts three_slots() {
    AtlasLayouts layouts;
    layouts[0] = atlas_layout(16, 2, {64, 64});
    layouts[1] = atlas_layout(32, 1, {64, 64});
    return layouts;
}

BillboardVersions in_slot(AtlasSlot slot, std::uint64_t last_shown) {
    BillboardVersions versions;
    versions.current.emplace().slot = slot;
    versions.last_shown = last_shown;
    return versions;
}

TEST(VersionSlots, TheLongestUnseenGivesWayBeforeAnotherSizeIsTaken) {
    VersionSlots slots{three_slots(), false};
    BillboardVersions seen = in_slot(*slots.reserve(0, 1), 9);
    BillboardVersions unseen = in_slot(*slots.reserve(0, 1), 4);
    slots.add(seen);
    slots.add(unseen);
    const AtlasSlot given_up = unseen.current->slot;
    EXPECT_EQ(slots.reserve(0, 10), given_up);
    EXPECT_FALSE(unseen.current.has_value());
    EXPECT_EQ(slots.reserve(0, 10)->level, 1U) << "what the last frame showed stays";
    EXPECT_FALSE(slots.reserve(0, 10).has_value());
    EXPECT_TRUE(seen.current.has_value());
}

TEST(VersionSlots, WhatAFrameGivesUpIsKeptUntilTheNext) {
    VersionSlots slots{three_slots(), true};
    BillboardVersions versions = in_slot(*slots.reserve(1, 1), 1);
    slots.forget(versions);
    EXPECT_EQ(slots.reserve(1, 1)->level, 0U);
    slots.begin_frame();
    EXPECT_EQ(slots.reserve(1, 2)->level, 1U);
}

TEST(VersionSlots, TheEndOfAFadeFreesTheOldVersionOnly) {
    VersionSlots slots{three_slots(), false};
    BillboardVersions versions = in_slot(*slots.reserve(0, 1), 1);
    versions.previous.emplace().slot = *slots.reserve(1, 1);
    slots.end_fade(versions);
    EXPECT_FALSE(versions.previous.has_value());
    EXPECT_TRUE(versions.current.has_value());
    EXPECT_EQ(slots.reserve(1, 1)->level, 1U);
}

TEST(BillboardVersions, AFadeStepsFromTheOldVersionToTheNew) {
    BillboardVersions versions = in_slot({0, 0}, 1);
    EXPECT_EQ(versions.look(3).fade, 1.0f) << "nothing fades";
    versions.previous.emplace();
    versions.fade = 1;
    EXPECT_EQ(versions.look(3).fade, 0.25f);
    EXPECT_TRUE(versions.look(3).previous.has_value());
}

}  // namespace
}  // namespace lw
