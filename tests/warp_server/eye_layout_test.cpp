#include "warp_server/eye_layout.h"

#include <gtest/gtest.h>

namespace lw::test {
namespace {

const ColourImage kLeft{{3, 2}, {10, 20, 30, 255}};
const ColourImage kRight{{3, 2}, {40, 50, 60, 255}};

ColourImage packed(EyeLayout layout) {
    ColourImage picture;
    pack_eyes(layout, kLeft, kRight, picture);
    EXPECT_EQ(picture.size_px(), packed_size_px(layout, kLeft.size_px()));
    return picture;
}

TEST(EyeLayout, NamesAreThoseOfTheCommandLine) {
    for (const std::string_view name : eye_layout_names()) EXPECT_EQ(name_of(*find_eye_layout(name)), name);
    EXPECT_FALSE(find_eye_layout("hologram").has_value());
}

TEST(EyeLayout, SideBySideKeepsEachEyeOnItsSide) {
    for (const EyeLayout layout : {EyeLayout::side_by_side, EyeLayout::files}) {
        const ColourImage picture = packed(layout);
        EXPECT_EQ(picture.size_px(), glm::ivec2(6, 2));
        EXPECT_EQ(picture.at(2, 1), kLeft.at(0, 0));
        EXPECT_EQ(picture.at(3, 0), kRight.at(0, 0));
    }
}

TEST(EyeLayout, TopBottomHasTheLeftEyeOnTop) {
    const ColourImage picture = packed(EyeLayout::top_bottom);
    EXPECT_EQ(picture.size_px(), glm::ivec2(3, 4));
    EXPECT_EQ(picture.at(1, 1), kLeft.at(0, 0));
    EXPECT_EQ(picture.at(1, 2), kRight.at(0, 0));
}

TEST(EyeLayout, TheRedGlassIsTheLeftEyes) { EXPECT_EQ(packed(EyeLayout::anaglyph).at(0, 0), (Rgba8{10, 50, 60, 255})); }

}  // namespace
}  // namespace lw::test
