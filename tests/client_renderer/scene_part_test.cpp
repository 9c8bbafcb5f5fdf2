#include "client_renderer/scene_part.h"

#include <glm/gtc/matrix_transform.hpp>

#include "client_renderer/hidden_layer.h"
#include "core/colour.h"
#include "tests/client_renderer/hand_made_scenes.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

constexpr glm::ivec2 kSize_px{32, 32};

/// Squares of side 2 that face the eye: red at 2 m, green at 5 m and ten times as large, blue at 20 m and larger yet.
scene::Scene three_squares() {
    scene::Scene scene;
    const glm::vec4 colours[] = {{0.8f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.8f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.8f, 1.0f}};
    const double distances_m[] = {2.0, 5.0, 20.0};
    const double sizes[] = {1.0, 10.0, 100.0};
    for (int i = 0; i < 3; ++i) {
        scene.materials.push_back(test::unlit_material(colours[i]));
        scene.meshes.push_back(test::square_mesh(i));
        const glm::dmat4 placed = glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -distances_m[i]});
        test::add_instance(scene, i, glm::scale(placed, glm::dvec3{sizes[i]}));
    }
    scene.finish();
    return scene;
}

class GlScenePart : public test::GlTest {
protected:
    void SetUp() override {
        test::GlTest::SetUp();
        if (IsSkipped()) return;
        // Nothing is culled: what a part leaves out must be left out by the part.
        SceneRendererSettings settings;
        settings.culling.occlusion = false;
        auto made = SceneRenderer::create(scene_, settings);
        ASSERT_TRUE(made.ok()) << made.error().message();
        renderer_ = std::move(*made);
    }
    void TearDown() override {
        renderer_.reset();
        test::GlTest::TearDown();
    }

    scene::Scene scene_ = three_squares();
    std::unique_ptr<SceneRenderer> renderer_;
};

TEST_F(GlScenePart, TheWholeSceneIsAPartBitForBit) {
    const Camera camera = test::plain_camera(kSize_px);
    for (const int samples : {1, 2}) {
        CpuPixels whole;
        CpuPixels part;
        renderer_->draw_resolved(camera, 0.0, samples, whole);
        EXPECT_EQ(renderer_->draw_part(camera, 0.0, samples, {}, part), 0U);
        EXPECT_EQ(part.colour, whole.colour);
        EXPECT_EQ(part.depth, whole.depth);
    }
}

TEST_F(GlScenePart, ARangeHoldsWhatIsInItAlongTheRay) {
    const Camera camera = test::plain_camera(kSize_px);
    ScenePart middle;
    middle.nearest_m = 3.0;
    middle.farthest_m = 6.0;
    middle.sky = false;
    CpuPixels pixels;
    const std::uint64_t empty = renderer_->draw_part(camera, 0.0, 1, middle, pixels);
    std::uint64_t counted = 0;
    for (int y = 0; y < kSize_px.y; ++y) {
        for (int x = 0; x < kSize_px.x; ++x) {
            const double right = (x + 0.5) / 16.0 - 1.0;
            const double up = 1.0 - (y + 0.5) / 16.0;
            const double ray_m = 5.0 * std::sqrt(right * right + up * up + 1.0);
            const bool inside = ray_m < 6.0;
            EXPECT_EQ(pixels.depth.at(x, y) != kNoSurfaceDepth, inside) << x << ", " << y;
            if (inside) {
                EXPECT_NEAR(pixels.depth.at(x, y), 0.05 / 5.0, 1e-6);
            }
            counted += inside ? 0 : 1;
        }
    }
    EXPECT_EQ(empty, counted);
}

TEST_F(GlScenePart, SkyBelongsToThePartThatAsksForIt) {
    Camera up = test::plain_camera(kSize_px);
    up.world_from_eye.orientation = glm::angleAxis(3.14159 / 2, glm::dvec3{1.0, 0.0, 0.0});
    CpuPixels pixels;
    ScenePart part;
    part.farthest_m = 1.0;
    EXPECT_EQ(renderer_->draw_part(up, 0.0, 1, part, pixels), 0U);
    EXPECT_EQ(pixels.depth.at(16, 16), 0.0F);
    part.sky = false;
    EXPECT_EQ(renderer_->draw_part(up, 0.0, 1, part, pixels), 32U * 32U);
}

TEST_F(GlScenePart, AHiddenLayerHasTheWallBehindTheEdgeOfTheSquare) {
    Layer first;
    first.camera = test::plain_camera(kSize_px);
    for (const int samples : {1, 2}) {
        renderer_->draw_resolved(first.camera, 0.0, samples, first.cpu());
        Layer hidden;
        // 16 px * 0.5 m * (1/2 - 1/5) = 2.4 px: the red square covers the columns 8 to 23.
        draw_hidden_layer(*renderer_, first, samples, 0.5, hidden);
        for (const int x : {8, 9, 22, 23}) {
            EXPECT_NEAR(hidden.cpu().depth.at(x, 16), 0.05 / 5.0, 1e-6) << x;
            EXPECT_GT(hidden.cpu().colour.at(x, 16).g, 200) << x;
            EXPECT_EQ(hidden.cpu().colour.at(x, 16).r, 0) << x;
        }
        EXPECT_EQ(hidden.cpu().depth.at(16, 16), kNoSurfaceDepth) << "nobody looks behind its middle";
        EXPECT_EQ(hidden.cpu().depth.at(2, 16), kNoSurfaceDepth) << "the first layer shows it";
        EXPECT_GT(hidden.empty_pixels, 700U);
    }
}

TEST(ScenePart, BoxesAreInRangeWhereTheirNearestOrFarthestPointIs) {
    const scene::Bounds box{{2.0, -1.0, -1.0}, {4.0, 1.0, 1.0}};
    const glm::dvec3 eye{0.0};
    const auto with = [](double nearest_m, double farthest_m) {
        ScenePart part;
        part.nearest_m = nearest_m;
        part.farthest_m = farthest_m;
        return part;
    };
    EXPECT_TRUE(in_range(with(0.0, 2.5), box, false, eye));
    EXPECT_FALSE(in_range(with(0.0, 2.0), box, false, eye));
    EXPECT_TRUE(in_range(with(4.2, 9.0), box, false, eye)) << "its far corners are 4.24 m away";
    EXPECT_FALSE(in_range(with(4.3, 9.0), box, false, eye));
    EXPECT_TRUE(in_range(with(4.3, 9.0), box, true, eye)) << "a mover is in range at any distance";
    ScenePart statics = with(0.0, 9.0);
    statics.movers = false;
    EXPECT_FALSE(in_range(statics, box, true, eye));
}

}  // namespace
}  // namespace lw
