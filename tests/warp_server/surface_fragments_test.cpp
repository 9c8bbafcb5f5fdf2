#include "warp_server/methods/surface_fragments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace lw::test {
namespace {

constexpr std::size_t kPixels = 5 * SurfaceFragments::kStretch - 3;

// Pixel numbers of all fragments of a stretch, as often as it has them.
std::vector<std::size_t> pixels_of(SurfaceFragments& fragments, std::size_t stretch) {
    std::vector<std::size_t> pixels;
    fragments.visit(stretch, [&](const SurfaceFragment& fragment, std::uint32_t index) {
        EXPECT_EQ(&fragments.all()[index], &fragment);
        pixels.push_back(stretch * SurfaceFragments::kStretch + static_cast<std::size_t>(fragment.link));
    });
    std::ranges::sort(pixels);
    return pixels;
}

TEST(SurfaceFragments, AreAllWhereTheyWerePut) {
    SurfaceFragments fragments;
    for (int picture = 0; picture < 2; ++picture) {
        fragments.begin(kPixels);
        EXPECT_TRUE(fragments.empty());
        ASSERT_EQ(fragments.stretches(), 5U);
        std::vector<std::vector<std::size_t>> expected(5);
        for (std::size_t i = 0; i < 3000; ++i) {
            const std::size_t pixel = i * i * 7919 % kPixels;
            fragments.put(pixel, SurfaceFragment{});
            expected[pixel / SurfaceFragments::kStretch].push_back(pixel);
        }
        EXPECT_FALSE(fragments.empty());
        for (std::size_t stretch = 0; stretch < expected.size(); ++stretch) {
            std::ranges::sort(expected[stretch]);
            EXPECT_EQ(pixels_of(fragments, stretch), expected[stretch]);
        }
    }
}

TEST(SurfaceFragments, AStretchMayHaveAnyNumberOrNone) {
    SurfaceFragments fragments;
    fragments.begin(kPixels);
    for (int i = 0; i < 1000; ++i) fragments.put(kPixels - 1, SurfaceFragment{});
    EXPECT_EQ(pixels_of(fragments, 4), std::vector<std::size_t>(1000, kPixels - 1));
    for (std::size_t stretch = 0; stretch < 4; ++stretch) EXPECT_TRUE(pixels_of(fragments, stretch).empty());
}

}  // namespace
}  // namespace lw::test
