// Several samples per source pixel, resolved per surface.
#include "client_renderer/surface_resolve.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "client_renderer/scene_renderer.h"
#include "core/colour.h"
#include "tests/client_renderer/hand_made_scenes.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

class GlSurfaceResolve : public test::GlTest {
protected:
    static std::unique_ptr<SceneRenderer> make(const scene::Scene& scene) {
        auto renderer = SceneRenderer::create(scene);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message();
        return std::move(*renderer);
    }
    static CpuPixels draw(SceneRenderer& renderer, const Camera& camera, int samples_per_axis, double time_s = 0.0) {
        CpuPixels pixels;
        renderer.draw_resolved(camera, time_s, samples_per_axis, pixels);
        return pixels;
    }
};

constexpr Rgba8 kRed{255, 0, 0, 255};
constexpr Rgba8 kGreen{0, 255, 0, 255};

// A red square, turned so that its edges cross pixels everywhere, before a green wall: no colour between is theirs.
scene::Scene red_before_green() {
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 0, 0, 1}), test::unlit_material({0, 1, 0, 1})};
    scene.meshes = {test::square_mesh(0), test::square_mesh(1)};
    test::add_instance(scene, 1, glm::scale(glm::translate(glm::dmat4{1.0}, {0, 0, -6.0}), {20.0, 20.0, 1.0}));
    auto turned = glm::translate(glm::dmat4{1.0}, {0.07, -0.03, -3.0});
    turned = glm::rotate(turned, 0.3, {0.0, 0.0, 1.0});
    test::add_instance(scene, 0, glm::rotate(turned, 0.8, {0.0, 1.0, 0.0}));
    scene.finish();
    return scene;
}

TEST_F(GlSurfaceResolve, OneSampleIsDraw) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({40, 30});
    CpuPixels drawn;
    renderer->draw(camera, 0.0, drawn);
    const CpuPixels resolved = draw(*renderer, camera, 1);
    EXPECT_EQ(resolved.colour, drawn.colour);
    EXPECT_EQ(resolved.depth, drawn.depth);
    EXPECT_EQ(resolved.object_id, drawn.object_id);
}

TEST_F(GlSurfaceResolve, NoPixelMixesTwoSurfaces) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({64, 48});
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        int red = 0;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                const Rgba8 colour = opaque(pixels.colour.at(x, y));
                const double distance = distance_m(pixels.depth.at(x, y), camera.near_m);
                ASSERT_TRUE(colour == kRed || colour == kGreen) << samples << ": " << x << " " << y;
                // The wall is 6 m away; of the square the farthest corner at 3 m + 1 m.
                const bool on_its_surface = colour == kGreen ? std::abs(distance - 6.0) < 1e-4 : distance < 4.1;
                ASSERT_TRUE(on_its_surface) << samples << ": " << x << " " << y << " at " << distance;
                red += colour == kRed ? 1 : 0;
            }
        }
        EXPECT_GT(red, 100) << samples;
    }
}

TEST_F(GlSurfaceResolve, APlanesDepthIsThatOfThePixelsCentreUpToItsEdges) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({64, 48});
    // The square's plane, from its placement.
    auto turned = glm::translate(glm::dmat4{1.0}, {0.07, -0.03, -3.0});
    turned = glm::rotate(glm::rotate(turned, 0.3, {0.0, 0.0, 1.0}), 0.8, {0.0, 1.0, 0.0});
    const glm::dvec3 normal{turned[2]};
    const double plane = glm::dot(normal, glm::dvec3{turned[3]});
    const glm::dmat4 eye_from_px = source_eye_from_source_px(camera).matrix;
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        double worst = 0.0;
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                if (opaque(pixels.colour.at(x, y)) != kRed) continue;
                const glm::dvec3 ray{eye_from_px * glm::dvec4{x + 0.5, y + 0.5, 1.0, 0.0}};
                const double exact = camera.near_m * glm::dot(normal, ray) / plane;
                worst = std::max(worst, std::abs(pixels.depth.at(x, y) / exact - 1.0));
            }
        }
        // Float rounding of depths, carried on by up to a pixel with their differences.
        EXPECT_LT(worst, 1e-5) << samples;
    }
}

TEST_F(GlSurfaceResolve, QuartersShowAllThatIsInThemAndWhichPartIsTheSurfaces) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({64, 48});
    EXPECT_TRUE(draw(*renderer, camera, 1).quarters.empty());
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        ASSERT_EQ(pixels.quarters.size_px(), glm::ivec2(128, 96)) << samples;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 128; ++x) {
                const Rgba8 quarter = pixels.quarters.at(x, y);
                const Rgba8 pixel = pixels.colour.at(x / 2, y / 2);
                if (quarter.a == 255) {
                    ASSERT_EQ(opaque(quarter), opaque(pixel)) << samples << ": " << x << " " << y;
                } else {
                    ASSERT_NE(opaque(quarter), opaque(pixel)) << samples << ": " << x << " " << y;
                }
            }
        }
        // The pixel's share is the mean of its quarters', each rounded by itself.
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                int sum = 0;
                for (int i = 0; i < 4; ++i) sum += pixels.quarters.at(2 * x + i % 2, 2 * y + i / 2).a;
                ASSERT_NEAR(0.25 * sum, pixels.colour.at(x, y).a, 1.0) << samples << ": " << x << " " << y;
            }
        }
    }
}

TEST_F(GlSurfaceResolve, ThePixelIsTheMeanOfItsQuarters) {
    // A wall with lights and shades. At its end the sky is in its pixels' quarters, and not in the pixels.
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 1, 1, 1})};
    scene.materials.front() = {};
    scene.meshes = {test::square_mesh(0)};
    auto wall = glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -2.0});
    wall = glm::rotate(wall, 0.7, {0.0, 1.0, 0.0});
    test::add_instance(scene, 0, glm::scale(wall, {20.0, 20.0, 1.0}));
    scene.finish();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({32, 24});
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        int whole = 0;
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 32; ++x) {
                if (pixels.colour.at(x, y).a != 255) continue;
                ++whole;
                float mean = 0.0F;
                for (int i = 0; i < 4; ++i) {
                    mean += 0.25F * linear_of(pixels.quarters.at(2 * x + i % 2, 2 * y + i / 2)).g;
                }
                // Each quarter is rounded by itself: half a level each.
                ASSERT_NEAR(srgb8_from_linear(mean), pixels.colour.at(x, y).g, 1) << samples << ": " << x << " " << y;
            }
        }
        EXPECT_GT(whole, 30 * 24) << samples;
    }
}

TEST_F(GlSurfaceResolve, AlphaIsTheShareThatTheSurfaceCovers) {
    // The square's left edge stands upright in column 5: a quarter of that column's pixels is the square's.
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 0, 0, 1})};
    scene.meshes = {test::square_mesh(0)};
    constexpr double kEdge = 2.0 * 5.75 / 16.0 - 1.0;  // of the picture's half width, at 1 m
    auto right = glm::translate(glm::dmat4{1.0}, {kEdge + 4.0, 0.0, -1.0});
    test::add_instance(scene, 0, glm::scale(right, {4.0, 4.0, 1.0}));
    scene.finish();
    auto renderer = make(scene);
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, test::plain_camera({16, 16}), samples);
        EXPECT_TRUE(pixels.alpha_is_share);
        // Of two samples across, at a quarter and three quarters, the second lies on the edge and may be either's.
        if (samples == 4) {
            EXPECT_EQ(pixels.colour.at(5, 8).a, 191);
        }
        EXPECT_EQ(pixels.colour.at(4, 8).a, 255);
        EXPECT_EQ(pixels.colour.at(6, 8).a, 255);
        EXPECT_FALSE(draw(*renderer, test::plain_camera({16, 16}), 1).alpha_is_share);
    }
}

TEST_F(GlSurfaceResolve, AGrazingFloorKeepsTheDepthOfOneSample) {
    scene::Scene scene;
    scene.materials = {test::unlit_material({0.5f, 0.5f, 0.5f, 1.0f})};
    scene.meshes = {test::square_mesh(0)};
    // 20 cm below the eye, out to 50 m: near its far end depth halves from one row to the next.
    auto floor = glm::translate(glm::dmat4{1.0}, {0.0, -0.2, -25.2});
    floor = glm::rotate(floor, -1.5707963267948966, {1.0, 0.0, 0.0});
    test::add_instance(scene, 0, glm::scale(floor, {50.0, 25.0, 1.0}));
    scene.finish();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({48, 48});
    const CpuPixels one = draw(*renderer, camera, 1);
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        double worst = 0.0;
        int floor_px = 0;
        for (std::size_t i = 0; i < one.depth.pixels().size(); ++i) {
            const float expected = one.depth.pixels()[i];
            const float actual = pixels.depth.pixels()[i];
            if (expected == 0.0f || actual == 0.0f) continue;
            worst = std::max(worst, std::abs(static_cast<double>(actual) / expected - 1.0));
            ++floor_px;
        }
        EXPECT_GT(floor_px, 48 * 20);
        // The rasteriser's plane is exact to a few ulps of the largest depth on the triangle (0.25), and the floor
        // fades to 0.001.
        EXPECT_LT(worst, 2e-5) << samples;
    }
}

TEST_F(GlSurfaceResolve, ASurfaceIsAveragedInLinearLight) {
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 1, 1, 1})};
    scene::TextureImage image;
    // A chequerboard as fine as the samples: 32 x 32 texels over 16 x 16 pixels.
    image.pixels = ColourImage{{32, 32}};
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            image.pixels.at(x, y) = (x + y) % 2 == 0 ? Rgba8{255, 255, 255, 255} : Rgba8{0, 0, 0, 255};
        }
    }
    scene.images.push_back(image);
    scene.materials[0].base_colour_texture.image = 0;
    scene.materials[0].base_colour_texture.nearest = true;
    scene.meshes = {test::square_mesh(0)};
    test::add_instance(scene, 0, glm::translate(glm::dmat4{1.0}, {0.0, 0.0, -1.0}));
    scene.finish();
    auto renderer = make(scene);
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, test::plain_camera({16, 16}), samples);
        const Rgba8 grey = srgb8_of(glm::vec3{0.5f});
        for (const Rgba8 colour : pixels.colour.pixels()) ASSERT_EQ(colour, grey) << samples;
        for (const float depth : pixels.depth.pixels()) ASSERT_EQ(depth, 0.05f) << samples;
    }
}

TEST_F(GlSurfaceResolve, BackgroundIsASurface) {
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 0, 0, 1})};
    scene.meshes = {test::square_mesh(0)};
    // So far away that its depth is 5e-6: near to nothing, and still not background.
    test::add_instance(scene, 0, glm::scale(glm::translate(glm::dmat4{1.0}, {120.0, 300.0, -1e4}), {5e3, 5e3, 1.0}));
    scene.finish();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({37, 37});
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, camera, samples);
        int sky = 0;
        for (std::size_t i = 0; i < pixels.depth.pixels().size(); ++i) {
            const bool red = opaque(pixels.colour.pixels()[i]) == kRed;
            ASSERT_EQ(pixels.depth.pixels()[i] > 0.0f, red) << samples << ": " << i;
            ASSERT_TRUE(red || pixels.colour.pixels()[i].g > 50) << "sky has none of the square's colour";
            sky += red ? 0 : 1;
        }
        EXPECT_GT(sky, 500);
        EXPECT_LT(sky, 37 * 37 - 200);
    }
}

TEST_F(GlSurfaceResolve, ObjectsOfOneDepthStayApart) {
    // Two squares in one plane, of which one moves: only the id tells them apart.
    scene::Scene scene;
    scene.materials = {test::unlit_material({1, 0, 0, 1}), test::unlit_material({0, 1, 0, 1})};
    scene.meshes = {test::square_mesh(0), test::square_mesh(1)};
    scene.nodes.resize(2);
    scene.nodes[0].translation = {-0.97, 0.0, -1.0};
    scene.nodes[1].translation = {1.03, 0.0, -1.0};
    scene.instances = {{0, 0, glm::dmat4{1.0}, 0}, {1, 1, glm::dmat4{1.0}, 0}};
    scene::AnimationChannel channel;
    channel.node = 1;
    channel.loop_s = 10.0;
    channel.times_s = {0.0f, 10.0f};
    channel.values = {{1.03f, 0.0f, -1.0f, 0.0f}, {1.03f, 5.0f, -1.0f, 0.0f}};
    scene.channels.push_back(channel);
    scene.finish();
    auto renderer = make(scene);
    for (const int samples : {2, 4}) {
        const CpuPixels pixels = draw(*renderer, test::plain_camera({20, 20}), samples);
        for (int y = 2; y < 18; ++y) {
            for (int x = 0; x < 20; ++x) {
                const bool moves = pixels.object_id.at(x, y) != 0;
                ASSERT_EQ(opaque(pixels.colour.at(x, y)), moves ? kGreen : kRed) << samples << ": " << x << " " << y;
            }
        }
    }
}

TEST_F(GlSurfaceResolve, TilesDoNotShow) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    // 4 samples a side: tiles of 512 pixels, so 1030 pixels take three.
    Camera camera = test::plain_camera({1030, 24});
    camera.fov = {-1.0, 1.0, -0.1, 0.1};
    const CpuPixels pixels = draw(*renderer, camera, 4);
    for (int y = 0; y < 24; ++y) {
        for (int x = 1; x < 1030; ++x) {
            const Rgba8 colour = opaque(pixels.colour.at(x, y));
            ASSERT_TRUE(colour == kRed || colour == kGreen) << x << " " << y;
            // Within a surface depth changes by less than 1 % from pixel to pixel.
            if (colour != opaque(pixels.colour.at(x - 1, y))) continue;
            ASSERT_NEAR(pixels.depth.at(x, y) / pixels.depth.at(x - 1, y), 1.0f, 0.01f) << x << " " << y;
        }
    }
    EXPECT_EQ(pixels.colour.at(0, 0), kGreen);
    EXPECT_EQ(pixels.colour.at(1029, 23), kGreen);
    EXPECT_EQ(pixels.colour.at(515, 12), kRed);
}

TEST_F(GlSurfaceResolve, TexturesHoldWhatCpuPixelsHold) {
    const scene::Scene scene = red_before_green();
    auto renderer = make(scene);
    const Camera camera = test::plain_camera({48, 40});
    const CpuPixels expected = draw(*renderer, camera, 2);
    const TexturePixels textures = renderer->draw_to_textures(camera, 0.0, 2);
    CpuPixels actual{ColourImage{{48, 40}}, DepthImage{{48, 40}}, ObjectIdImage{{48, 40}}};
    textures.colour.download(GL_RGBA, GL_UNSIGNED_BYTE, actual.colour.size_bytes(), actual.colour.pixels().data());
    textures.depth.download(GL_RED, GL_FLOAT, actual.depth.size_bytes(), actual.depth.pixels().data());
    textures.object_id.download(GL_RED_INTEGER, GL_UNSIGNED_SHORT, actual.object_id.size_bytes(),
                                actual.object_id.pixels().data());
    EXPECT_EQ(actual.colour, expected.colour);
    EXPECT_EQ(actual.depth, expected.depth);
    EXPECT_EQ(actual.object_id, expected.object_id);
}

}  // namespace
}  // namespace lw
