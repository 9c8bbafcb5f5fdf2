#include "client_renderer/scene_renderer.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "core/colour.h"
#include "tests/client_renderer/hand_made_scenes.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

class GlSceneRenderer : public test::GlTest {
protected:
    std::unique_ptr<SceneRenderer> make(const scene::Scene& scene, SceneRendererSettings settings = {}) {
        auto renderer = SceneRenderer::create(scene, settings);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message();
        return std::move(*renderer);
    }
    static CpuPixels draw(SceneRenderer& renderer, const Camera& camera, double time_s = 0.0) {
        CpuPixels pixels;
        renderer.draw(camera, time_s, pixels);
        return pixels;
    }
};

// The G-buffer keeps square roots in 8 bits, so a stored colour is off by up to 2 * sqrt(c) * 0.5 / 255 in linear
// light: 1 step of 255 in sRGB.
constexpr int kColourSteps = 1;

void expect_colour(Rgba8 actual, const glm::vec3& linear) {
    const Rgba8 expected = srgb8_of(linear);
    EXPECT_NEAR(actual.r, expected.r, kColourSteps);
    EXPECT_NEAR(actual.g, expected.g, kColourSteps);
    EXPECT_NEAR(actual.b, expected.b, kColourSteps);
    EXPECT_EQ(actual.a, 255);
}

TEST_F(GlSceneRenderer, AnEmptySceneIsSkyAtDepthZero) {
    scene::Scene scene;
    scene.finish();
    auto renderer = make(scene);
    const CpuPixels pixels = draw(*renderer, test::plain_camera({16, 16}));
    for (const float depth : pixels.depth.pixels()) EXPECT_EQ(depth, 0.0f);
    for (const ObjectId id : pixels.object_id.pixels()) EXPECT_EQ(id, 0);
    const Rgba8 up = pixels.colour.at(8, 0);
    const Rgba8 down = pixels.colour.at(8, 15);
    EXPECT_GT(up.b, up.r) << "a blue sky in the top row";
    EXPECT_GT(down.r, down.b) << "ground in the bottom row";
}

TEST_F(GlSceneRenderer, TheSkyDependsOnDirectionAlone) {
    scene::Scene scene;
    scene.finish();
    auto renderer = make(scene);
    Camera camera = test::plain_camera({32, 32});
    const CpuPixels here = draw(*renderer, camera);
    camera.world_from_eye.position_m = {1000.0, 50.0, -3000.0};
    EXPECT_EQ(draw(*renderer, camera).colour, here.colour);
}

// A square of side 2, 2 m ahead, covers the middle half of a 90 degree view in both directions.
scene::Scene one_square(const glm::vec4& colour, const glm::dmat4& world_from_object) {
    scene::Scene scene;
    scene.materials.push_back(test::unlit_material(colour));
    scene.meshes.push_back(test::square_mesh(0));
    test::add_instance(scene, 0, world_from_object);
    scene.finish();
    return scene;
}

TEST_F(GlSceneRenderer, ASquareHasKnownPixels) {
    const glm::vec3 linear{0.8f, 0.3f, 0.05f};
    const auto scene = one_square({linear, 1.0f}, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -2.0}));
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({16, 16});
    const CpuPixels pixels = draw(*renderer, camera);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const bool inside = x >= 4 && x < 12 && y >= 4 && y < 12;
            // 0.05f / 2 is exact: one rounding of near_m, none of the division by a power of two.
            EXPECT_EQ(pixels.depth.at(x, y), inside ? 0.05f / 2.0f : 0.0f) << x << " " << y;
            EXPECT_EQ(pixels.object_id.at(x, y), 0);
        }
    }
    expect_colour(pixels.colour.at(4, 4), linear);
    expect_colour(pixels.colour.at(11, 11), linear);
    EXPECT_EQ(renderer->counters().triangles_drawn, 2U);
    EXPECT_EQ(renderer->counters().draw_calls, 1U);
}

TEST_F(GlSceneRenderer, UpIsTowardsRowZeroAndRightTowardsTheLastColumn) {
    const auto scene = one_square({1.0f, 1.0f, 1.0f, 1.0f}, glm::translate(glm::dmat4{1.0}, {1.0, 1.0, -2.0}));
    auto renderer = make(scene);
    const CpuPixels pixels = draw(*renderer, test::plain_camera({16, 16}));
    EXPECT_GT(pixels.depth.at(12, 3), 0.0f);
    EXPECT_EQ(pixels.depth.at(3, 3), 0.0f);
    EXPECT_EQ(pixels.depth.at(12, 12), 0.0f);
}

TEST_F(GlSceneRenderer, BacksAreHiddenUnlessDoubleSided) {
    const auto turned = glm::rotate(glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -2.0}), 3.141592653589793, {0, 1, 0});
    auto scene = one_square({1.0f, 1.0f, 1.0f, 1.0f}, turned);
    EXPECT_EQ(draw(*make(scene), test::plain_camera({8, 8})).depth.at(4, 4), 0.0f);
    scene.materials[0].double_sided = true;
    EXPECT_GT(draw(*make(scene), test::plain_camera({8, 8})).depth.at(4, 4), 0.0f);
}

TEST_F(GlSceneRenderer, MirroredInstancesKeepTheirFronts) {
    const auto mirrored = glm::scale(glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -2.0}), {-1.0, 1.0, 1.0});
    const auto scene = one_square({1.0f, 1.0f, 1.0f, 1.0f}, mirrored);
    EXPECT_GT(draw(*make(scene), test::plain_camera({8, 8})).depth.at(4, 4), 0.0f);
}

TEST_F(GlSceneRenderer, DepthOfASlantedPlaneIsNearOverDistanceAndAffineInPixels) {
    // A big square turned about two axes, so that it covers the whole view at a slant.
    auto placement = glm::translate(glm::dmat4{1.0}, {0.3, -0.2, -4.0});
    placement = glm::rotate(placement, 0.6, {0.0, 1.0, 0.0});
    placement = glm::rotate(placement, -0.4, {1.0, 0.0, 0.0});
    const auto scene = one_square({1.0f, 1.0f, 1.0f, 1.0f}, glm::scale(placement, {40.0, 40.0, 1.0}));
    Camera camera = test::plain_camera({64, 48});
    camera.fov = {-0.7, 0.5, -0.4, 0.6};
    const CpuPixels pixels = draw(*make(scene), camera);
    const glm::dvec3 normal{placement[2]};
    const double plane = glm::dot(normal, glm::dvec3{placement[3]});
    const glm::dmat4 eye_from_px = source_eye_from_source_px(camera).matrix;
    double worst = 0.0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::dvec3 ray{eye_from_px * glm::dvec4{x + 0.5, y + 0.5, 1.0, 0.0}};
            const double distance_m = plane / glm::dot(normal, ray);
            worst = std::max(worst, std::abs(pixels.depth.at(x, y) - camera.near_m / distance_m));
        }
    }
    // Float rounding of positions and of the rasteriser's plane equation: a few ulps (6e-8) of the largest depth on
    // the triangles, 0.05 / 0.05 m where they cross the near plane.
    EXPECT_LT(worst, 1e-6);
}

TEST_F(GlSceneRenderer, NearerSurfacesWinWhateverTheOrder) {
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 0, 0, 1}), test::unlit_material({0, 1, 0, 1})};
    scene.meshes = {test::square_mesh(0), test::square_mesh(1)};
    test::add_instance(scene, 1, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -1.5}));
    test::add_instance(scene, 0, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -2.0}));
    test::add_instance(scene, 0, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -3.0}));
    scene.finish();
    const CpuPixels pixels = draw(*make(scene), test::plain_camera({8, 8}));
    expect_colour(pixels.colour.at(4, 4), {0.0f, 1.0f, 0.0f});
}

TEST_F(GlSceneRenderer, MoversCarryTheirIdAndMoveWithTime) {
    scene::Scene scene;
    scene.materials.push_back(test::unlit_material({1, 1, 1, 1}));
    scene.meshes.push_back(test::square_mesh(0));
    scene.nodes.resize(2);
    scene.nodes[0].translation = {0.0, 0.0, -40.0};
    scene.nodes[0].scale = {100.0, 100.0, 1.0};
    scene.nodes[1].translation = {-2.0, 0.0, -4.0};
    scene.instances = {{0, 0, glm::dmat4{1.0}, 0}, {0, 1, glm::dmat4{1.0}, 0}};
    scene::AnimationChannel channel;
    channel.node = 1;
    channel.loop_s = 10.0;
    channel.times_s = {0.0f, 10.0f};
    channel.values = {{-2.0f, 0.0f, -4.0f, 0.0f}, {8.0f, 0.0f, -4.0f, 0.0f}};  // 1 m/s
    scene.channels.push_back(channel);
    scene.finish();
    ASSERT_EQ(scene.movers.size(), 1U);
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({16, 16});
    const CpuPixels at_0 = draw(*renderer, camera, 0.0);
    const CpuPixels at_3 = draw(*renderer, camera, 3.0);
    EXPECT_EQ(at_0.object_id.at(4, 8), 1);  // x = -2 m at 4 m: column 4
    EXPECT_EQ(at_0.object_id.at(10, 8), 0);
    EXPECT_EQ(at_3.object_id.at(4, 8), 0);
    EXPECT_EQ(at_3.object_id.at(10, 8), 1);
    std::vector<ObjectTransform> placements;
    renderer->mover_placements(3.0, placements);
    ASSERT_EQ(placements.size(), 1U);
    EXPECT_EQ(placements[0].id, 1);
    EXPECT_NEAR(placements[0].world_from_object[3].x, 1.0, 1e-6);  // key frames are floats
}

TEST_F(GlSceneRenderer, AlphaMasksCutHoles) {
    auto scene = one_square({1, 1, 1, 1}, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -1.0}));
    scene::TextureImage image;
    image.pixels = ColourImage{{2, 2}, Rgba8{255, 255, 255, 255}};
    image.pixels.at(1, 0) = {255, 255, 255, 0};  // the upper right quarter
    scene.images.push_back(image);
    scene.materials[0].base_colour_texture.image = 0;
    scene.materials[0].base_colour_texture.nearest = true;
    scene.materials[0].alpha_cutoff = 0.5f;
    const CpuPixels pixels = draw(*make(scene), test::plain_camera({16, 16}));
    EXPECT_EQ(pixels.depth.at(13, 2), 0.0f);
    EXPECT_GT(pixels.depth.at(2, 2), 0.0f);
    EXPECT_GT(pixels.depth.at(2, 13), 0.0f);
    EXPECT_GT(pixels.depth.at(13, 13), 0.0f);
}

TEST_F(GlSceneRenderer, TexturesAreReadTopRowFirstAndAsSrgb) {
    auto scene = one_square({1, 1, 1, 1}, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -1.0}));
    scene::TextureImage image;
    image.pixels = ColourImage{{2, 2}, Rgba8{90, 90, 90, 255}};
    image.pixels.at(0, 0) = {200, 20, 100, 255};
    scene.images.push_back(image);
    scene.materials[0].base_colour_texture.image = 0;
    scene.materials[0].base_colour_texture.nearest = true;
    const CpuPixels pixels = draw(*make(scene), test::plain_camera({16, 16}));
    expect_colour(pixels.colour.at(3, 3), linear_of({200, 20, 100, 255}));
    expect_colour(pixels.colour.at(3, 12), linear_of({90, 90, 90, 255}));
    // The transform shifts by half a texture: the special texel appears at the lower right.
    scene.materials[0].base_colour_texture.uv_transform[2] = {0.5f, 0.5f, 1.0f};
    const CpuPixels shifted = draw(*make(scene), test::plain_camera({16, 16}));
    expect_colour(shifted.colour.at(12, 12), linear_of({200, 20, 100, 255}));
    expect_colour(shifted.colour.at(3, 3), linear_of({90, 90, 90, 255}));
}

TEST_F(GlSceneRenderer, VertexColoursMultiply) {
    auto scene = one_square({0.5f, 1.0f, 1.0f, 1.0f}, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -1.0}));
    for (scene::Vertex& vertex : scene.meshes[0].vertices) vertex.colour = {255, 51, 0, 255};  // linear 1, 0.2, 0
    expect_colour(draw(*make(scene), test::plain_camera({8, 8})).colour.at(4, 4), {0.5f, 0.2f, 0.0f});
}

// Lit scenes: boxes at random, some of them lit by point lights, seen from random places.
scene::Scene random_squares(unsigned seed) {
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    scene::Scene scene;
    for (int i = 0; i < 3; ++i) {
        scene::Material material;
        material.base_colour = {0.3f + 0.3f * static_cast<float>(i), 0.5f, 0.6f, 1.0f};
        material.metallic = 0.5f * static_cast<float>(i);
        material.roughness = 0.4f;
        material.double_sided = i == 1;
        scene.materials.push_back(material);
        scene.meshes.push_back(test::square_mesh(i));
    }
    for (int i = 0; i < 200; ++i) {
        auto placement = glm::translate(glm::dmat4{1.0}, 10.0 * glm::dvec3{unit(random), unit(random), unit(random)});
        placement = glm::rotate(placement, 3.0 * unit(random), {0.0, 1.0, 0.0});
        placement = glm::rotate(placement, 3.0 * unit(random), {1.0, 0.0, 0.0});
        test::add_instance(scene, i % 3, glm::scale(placement, glm::dvec3{1.0, 0.7 + 0.5 * unit(random), 1.0}));
    }
    for (int i = 0; i < 40; ++i) {
        scene.point_lights.push_back(
            {10.0 * glm::dvec3{unit(random), unit(random), unit(random)}, glm::vec3{2.0f, 1.5f, 1.0f}, 4.0f});
    }
    scene.finish();
    return scene;
}

Camera random_camera(std::mt19937& random, glm::ivec2 size_px) {
    std::uniform_real_distribution<double> unit{-1.0, 1.0};
    Camera camera = test::plain_camera(size_px);
    camera.world_from_eye.position_m = 8.0 * glm::dvec3{unit(random), unit(random), unit(random)};
    camera.world_from_eye.orientation =
        glm::normalize(glm::dquat{unit(random), unit(random), unit(random), unit(random)});
    return camera;
}

TEST_F(GlSceneRenderer, CullingChangesNoPixel) {
    const scene::Scene scene = random_squares(1);
    auto culling = make(scene);
    auto not_culling = make(scene, {.culling = {.skip = false}});
    std::mt19937 random{2};
    std::uint64_t culled = 0;
    for (int i = 0; i < 30; ++i) {
        const Camera camera = random_camera(random, {96, 64});
        const CpuPixels a = draw(*culling, camera);
        const CpuPixels b = draw(*not_culling, camera);
        ASSERT_EQ(a.depth, b.depth) << i;
        ASSERT_EQ(a.colour, b.colour) << i;
        culled += not_culling->counters().objects_drawn - culling->counters().objects_drawn;
    }
    EXPECT_GT(culled, 30U * 100U) << "more than half of the objects are out of view";
}

TEST_F(GlSceneRenderer, EqualArgumentsGiveEqualBytes) {
    const scene::Scene scene = random_squares(3);
    auto renderer = make(scene);
    auto other = make(scene);
    std::mt19937 random{4};
    const Camera first = random_camera(random, {80, 60});
    const Camera second = random_camera(random, {80, 60});
    const CpuPixels a = draw(*renderer, first);
    (void)draw(*renderer, second);
    const CpuPixels again = draw(*renderer, first);
    const CpuPixels elsewhere = draw(*other, first);
    EXPECT_EQ(a.colour, again.colour);
    EXPECT_EQ(a.depth, again.depth);
    EXPECT_EQ(a.colour, elsewhere.colour);
}

/// A warp method on the same context leaves its own state behind: it writes linear colour, for one.
TEST_F(GlSceneRenderer, StateThatOthersLeftDoesNotShow) {
    const scene::Scene scene = random_squares(3);
    auto renderer = make(scene);
    std::mt19937 random{4};
    const Camera camera = random_camera(random, {80, 60});
    for (const int samples : {1, 2}) {
        CpuPixels clean;
        CpuPixels after;
        ColourImage clean_truth;
        ColourImage after_truth;
        renderer->draw_resolved(camera, 0.0, samples, clean);
        renderer->draw_supersampled(camera, 0.0, samples, clean_truth);
        const auto leave_state = [] {
            glEnable(GL_FRAMEBUFFER_SRGB);
            glEnable(GL_BLEND);
            glEnable(GL_SCISSOR_TEST);
            glScissor(0, 0, 1, 1);
            glColorMask(GL_FALSE, GL_TRUE, GL_TRUE, GL_TRUE);
        };
        leave_state();
        renderer->draw_resolved(camera, 0.0, samples, after);
        leave_state();
        renderer->draw_supersampled(camera, 0.0, samples, after_truth);
        EXPECT_EQ(clean.colour, after.colour) << samples;
        EXPECT_EQ(clean_truth, after_truth) << samples;
    }
}

TEST_F(GlSceneRenderer, LightTilesDoNotShow) {
    // The same view as one picture and as the right half of one twice as wide: the tiles fall differently.
    const scene::Scene scene = random_squares(5);
    auto renderer = make(scene);
    std::mt19937 random{6};
    for (int i = 0; i < 10; ++i) {
        Camera wide = random_camera(random, {176, 88});  // 88 is no multiple of a tile
        wide.fov = {-2.0, 2.0, -1.0, 1.0};
        Camera right = wide;
        right.size_px = {88, 88};
        right.fov = {0.0, 2.0, -1.0, 1.0};
        const CpuPixels whole = draw(*renderer, wide);
        const CpuPixels half = draw(*renderer, right);
        int different = 0;
        for (int y = 0; y < 88; ++y) {
            for (int x = 0; x < 88; ++x) {
                const Rgba8 a = whole.colour.at(88 + x, y);
                const Rgba8 b = half.colour.at(x, y);
                different += std::abs(a.r - b.r) + std::abs(a.g - b.g) + std::abs(a.b - b.b) > 6 ? 1 : 0;
            }
        }
        // Rounding moves an edge across a sample now and then.
        EXPECT_LT(different, 88 * 88 / 500) << i;
    }
}

TEST_F(GlSceneRenderer, OneSamplePerAxisEqualsDraw) {
    const scene::Scene scene = random_squares(7);
    auto renderer = make(scene);
    std::mt19937 random{8};
    const Camera camera = random_camera(random, {70, 50});
    ColourImage truth;
    renderer->draw_supersampled(camera, 0.0, 1, truth);
    EXPECT_EQ(truth, draw(*renderer, camera).colour);
}

TEST_F(GlSceneRenderer, SupersamplingAveragesInLinearLight) {
    // White covers the left 4.5 pixels of a row: its edge pixel is half white, half sky-free black background square.
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 1, 1, 1}), test::unlit_material({0, 0, 0, 1})};
    scene.meshes = {test::square_mesh(0), test::square_mesh(1)};
    test::add_instance(scene, 1, glm::translate(glm::scale(glm::dmat4{1.0}, {9.0, 9.0, 1.0}), {0.0, 0.0, -2.0}));
    // At 1 m and 16 pixels over 2 m, half a pixel is 1/16 m.
    test::add_instance(scene, 0, glm::translate(glm::dmat4{1.0}, {-1.0 + 1.0 / 16.0, 0.0, -1.0}));
    scene.finish();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({16, 16});
    for (const int samples : {2, 4}) {
        ColourImage truth;
        renderer->draw_supersampled(camera, 0.0, samples, truth);
        EXPECT_EQ(truth.at(7, 8), (Rgba8{255, 255, 255, 255}));
        EXPECT_EQ(truth.at(9, 8), (Rgba8{0, 0, 0, 255}));
        EXPECT_EQ(truth.at(8, 8), srgb8_of(glm::vec3{0.5f})) << samples;
    }
}

TEST_F(GlSceneRenderer, LargeTruthIsDrawnInTilesWithoutSeams) {
    const scene::Scene scene = random_squares(9);
    auto renderer = make(scene);
    std::mt19937 random{10};
    // 4 samples a side: tiles of 512 pixels, so 1030 needs three, 344 pixels each and the last one cut.
    const Camera camera = random_camera(random, {1030, 32});
    ColourImage tiled;
    renderer->draw_supersampled(camera, 0.0, 4, tiled);
    // The same samples in one piece: averaged here from a picture four times as large.
    Camera fine = camera;
    fine.size_px *= 4;
    const CpuPixels samples = draw(*renderer, fine);
    int different = 0;
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 1030; ++x) {
            glm::vec3 sum{0.0f};
            for (int i = 0; i < 16; ++i) sum += linear_of(samples.colour.at(4 * x + i % 4, 4 * y + i / 4));
            const Rgba8 expected = srgb8_of(sum / 16.0f);
            const Rgba8 actual = tiled.at(x, y);
            // One step for the rounding of the shader's encoding, more only where rounding moved an edge sample.
            different += std::abs(actual.r - expected.r) > 1 || std::abs(actual.b - expected.b) > 1 ? 1 : 0;
        }
    }
    EXPECT_LT(different, 1030 * 32 / 500);
}

TEST_F(GlSceneRenderer, TexturesHoldWhatCpuPixelsHold) {
    const scene::Scene scene = random_squares(11);
    auto renderer = make(scene);
    std::mt19937 random{12};
    const Camera camera = random_camera(random, {48, 40});
    const CpuPixels expected = draw(*renderer, camera);
    const TexturePixels textures = renderer->draw_to_textures(camera, 0.0, 1);
    glFinish();
    EXPECT_TRUE(textures.rendered.signalled());
    CpuPixels actual{ColourImage{{48, 40}}, DepthImage{{48, 40}}, ObjectIdImage{{48, 40}}};
    textures.colour.download(GL_RGBA, GL_UNSIGNED_BYTE, actual.colour.size_bytes(), actual.colour.pixels().data());
    textures.depth.download(GL_RED, GL_FLOAT, actual.depth.size_bytes(), actual.depth.pixels().data());
    textures.object_id.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, actual.object_id.size_bytes(),
                                actual.object_id.pixels().data());
    EXPECT_EQ(actual.colour, expected.colour);
    EXPECT_EQ(actual.depth, expected.depth);
    EXPECT_EQ(actual.object_id, expected.object_id);
}

TEST_F(GlSceneRenderer, FarFromTheOriginNothingShakes) {
    // The same view 10,000 km away: positions as floats would be off by half a metre there.
    const glm::dvec3 far_away{1e7, 0.0, -1e7};
    const auto near_scene = one_square({1, 1, 1, 1}, glm::translate(glm::dmat4{1.0}, {0.2, 0.1, -2.0}));
    const auto far_scene =
        one_square({1, 1, 1, 1}, glm::translate(glm::dmat4{1.0}, far_away + glm::dvec3{0.2, 0.1, -2.0}));
    Camera camera = test::plain_camera({32, 32});
    const CpuPixels expected = draw(*make(near_scene), camera);
    camera.world_from_eye.position_m = far_away;
    const CpuPixels actual = draw(*make(far_scene), camera);
    for (std::size_t i = 0; i < expected.depth.pixels().size(); ++i) {
        // Doubles hold 2 nm there.
        EXPECT_NEAR(actual.depth.pixels()[i], expected.depth.pixels()[i], 1e-9) << i;
    }
}

TEST_F(GlSceneRenderer, ABareWhiteFloorIsBrighterThanItsUnderside) {
    scene::Scene scene;
    scene::Material material;
    material.metallic = 0.0f;
    material.double_sided = true;
    scene.materials.push_back(material);
    scene.meshes.push_back(test::square_mesh(0));
    test::add_instance(scene, 0, glm::rotate(glm::dmat4{1.0}, -1.5707963267948966, {1.0, 0.0, 0.0}));
    scene.finish();
    auto renderer = make(scene);
    Camera camera = test::plain_camera({8, 8});
    camera.world_from_eye = {{0.0, 1.0, 0.0}, glm::angleAxis(-1.5707963267948966, glm::dvec3{1.0, 0.0, 0.0})};
    const Rgba8 above = draw(*renderer, camera).colour.at(4, 4);
    camera.world_from_eye = {{0.0, -1.0, 0.0}, glm::angleAxis(1.5707963267948966, glm::dvec3{1.0, 0.0, 0.0})};
    const Rgba8 below = draw(*renderer, camera).colour.at(4, 4);
    EXPECT_GT(above.g, below.g + 40);
    EXPECT_GT(below.g, 60) << "the shade is not black";
    EXPECT_LT(above.g, 255) << "nor the light burnt out";
}

}  // namespace
}  // namespace lw
