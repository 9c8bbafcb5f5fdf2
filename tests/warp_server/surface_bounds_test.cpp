// Where regions of a prepared layer land, checked against where its pixels do.
#include "warp_server/methods/surface_bounds.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/held_depths.h"
#include "warp_server/methods/object_matrices.h"
#include "warp_server/methods/surface_classify.h"
#include "warp_server/methods/surface_tolerances.h"

namespace lw::test {
namespace {

class SurfaceBoundsTest : public ::testing::Test {
protected:
    SurfaceBoundsTest() {
        layer_ = AnalyticScene::street().draw(camera_, 0.0);
        for (ObjectId& id : layer_.cpu().object_id.pixels()) id = 0;
        target_.camera = camera_;
        target_.camera.world_from_eye.position_m += glm::dvec3{0.1, 0.05, -0.1};
        target_.camera.world_from_eye.orientation *= glm::angleAxis(0.1, glm::dvec3{0.0, 1.0, 0.0});
        matrices_.build(layer_, target_);
    }

    Camera camera_ = street_camera({300, 150});
    Layer layer_;
    WarpTarget target_;
    ObjectMatrices matrices_;
};

// A pixel may be nearer than the plane that it counts to, by as much as planes are told by.
// Whichever of its regions a pixel is in, some region reaches its place.
TEST_F(SurfaceBoundsTest, EveryPixelLandsWhereSomeRegionDoesAndNoNearer) {
    const auto prepared = classify_surfaces(layer_.cpu());
    ASSERT_EQ(prepared->bounds.size(), prepared->regions.size());
    const PixelMatrix& m = *matrices_.find(0);
    std::vector<RegionReach> reaches;
    for (const RegionBounds& bounds : prepared->bounds) {
        if (bounds.empty) continue;
        const std::optional<RegionReach> reach = reach_of(bounds, m);
        ASSERT_TRUE(reach.has_value());
        reaches.push_back(*reach);
    }
    EXPECT_GT(reaches.size(), 3U);
    for (int y = 0; y < camera_.size_px.y; ++y) {
        for (int x = 0; x < camera_.size_px.x; ++x) {
            const float depth = layer_.cpu().depth.at(x, y);
            const float sx = static_cast<float>(x) + 0.5F;
            const float sy = static_cast<float>(y) + 0.5F;
            const float w = m.x.w * sx + m.y.w * sy + m.one.w + m.z.w * depth;
            if (w <= 0.0F) continue;
            const glm::vec2 place{(m.x.x * sx + m.y.x * sy + m.one.x + m.z.x * depth) / w,
                                  (m.x.y * sx + m.y.y * sy + m.one.y + m.z.y * depth) / w};
            const bool reached = std::any_of(reaches.begin(), reaches.end(), [&](const RegionReach& reach) {
                const glm::vec2 first{reach.rect.first_px};
                const glm::vec2 end{reach.rect.end_px};
                return place.x >= first.x && place.y >= first.y && place.x <= end.x && place.y <= end.y &&
                       (1.0F - kPlaneDepthPart) * m.depth_scale * depth / w <= reach.nearest_depth;
            });
            ASSERT_TRUE(reached) << x << ", " << y;
        }
    }
}

TEST_F(SurfaceBoundsTest, NothingIsPromisedOfMoversAndBehindTheEye) {
    layer_.cpu().object_id.at(10, 10) = 1;
    const auto prepared = classify_surfaces(layer_.cpu());
    EXPECT_FALSE(reach_of(prepared->bounds.front(), *matrices_.find(0)).has_value());
    RegionBounds bounds = prepared->bounds.back();
    ASSERT_TRUE(bounds.static_only);
    target_.camera.world_from_eye.orientation = glm::angleAxis(3.0, glm::dvec3{0.0, 1.0, 0.0});
    matrices_.build(layer_, target_);
    EXPECT_FALSE(reach_of(bounds, *matrices_.find(0)).has_value());
}

TEST(AllNearer, OnePixelThatIsFartherShowsIt) {
    DepthImage shown{{40, 6}, 0.5F};
    EXPECT_TRUE(all_nearer(shown, {{1, 1}, {40, 5}}, 0.4F));
    shown.at(39, 4) = 0.3F;
    EXPECT_FALSE(all_nearer(shown, {{1, 1}, {40, 5}}, 0.4F));
    EXPECT_TRUE(all_nearer(shown, {{1, 1}, {39, 5}}, 0.4F));
}

TEST(HeldDepths, AreWhatTheyWereAfterwards) {
    std::array<float, 37> before{};
    for (std::size_t i = 0; i < before.size(); ++i) before[i] = i % 5 == 0 ? -1.5F : static_cast<float>(i) / 40.0F;
    std::array<float, 37> depths = before;
    hold_depths(depths.data(), depths.size(), 0.3F);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(depths[i], before[i] < 0.3F ? before[i] : kHeldDepth) << i;
    }
    depths[0] = 0.9F;
    release_depths(depths.data(), before.data(), depths.size());
    EXPECT_EQ(depths[0], 0.9F) << "drawn over";
    for (std::size_t i = 1; i < before.size(); ++i) EXPECT_EQ(depths[i], before[i]) << i;
}

}  // namespace
}  // namespace lw::test
