#include "client_renderer/sky_parts.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "client_renderer/frame_block.h"
#include "client_renderer/render_targets.h"
#include "client_renderer/sky_pass.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

const glm::dvec3 kRight{1.0, 0.0, 0.0};
const glm::dvec3 kUp{0.0, 1.0, 0.0};

/// Turned to the left, then raised.
Camera looking(double left_rad, double up_rad, glm::ivec2 size_px = {200, 170}) {
    Camera camera;
    camera.size_px = size_px;
    camera.fov = FovTangents::symmetric(1.2, static_cast<double>(size_px.x) / size_px.y);
    camera.world_from_eye.orientation = glm::angleAxis(left_rad, kUp) * glm::angleAxis(up_rad, kRight);
    return camera;
}

/// Behind a camera that looks ahead.
scene::Sun sun_behind() {
    scene::Sun sun;
    sun.direction_to_sun_world = glm::normalize(glm::dvec3{0.1, 0.7, 0.7});
    return sun;
}

SkyPart part_at(std::span<const SkyRect> rects, glm::ivec2 pixel) {
    for (const SkyRect& rect : rects) {
        if (glm::all(glm::greaterThanEqual(pixel, rect.first_px)) && glm::all(glm::lessThan(pixel, rect.end_px))) {
            return rect.part;
        }
    }
    ADD_FAILURE() << "no part at " << pixel.x << ", " << pixel.y;
    return SkyPart::sun;
}

TEST(SkyParts, CoverEveryPixelOnceInTheirOrder) {
    for (const double up_rad : {-1.5, -0.4, 0.0, 0.3, 0.9, 1.5}) {
        const Camera camera = looking(0.7, up_rad);
        SkyParts parts;
        parts.build(camera, sun_behind());
        Image<std::uint8_t> times{camera.size_px};
        SkyPart last = SkyPart::ground;
        for (const SkyRect& rect : parts.rects()) {
            EXPECT_LE(last, rect.part);
            last = rect.part;
            for (int y = rect.first_px.y; y < rect.end_px.y; ++y) {
                for (int x = rect.first_px.x; x < rect.end_px.x; ++x) ++times.at(x, y);
            }
        }
        for (const std::uint8_t count : times.pixels()) ASSERT_EQ(count, 1U) << up_rad;
    }
}

TEST(SkyParts, AreTheGroundBelowTheSkyAboveAndBothBetween) {
    SkyParts parts;
    parts.build(looking(0.0, 0.0), sun_behind());
    EXPECT_EQ(part_at(parts.rects(), {100, 5}), SkyPart::above);
    EXPECT_EQ(part_at(parts.rects(), {100, 85}), SkyPart::glow) << "the horizon";
    EXPECT_EQ(part_at(parts.rects(), {100, 165}), SkyPart::ground);
    // 64 + 64 + 42 rows: parts of a row and of those below go together.
    EXPECT_LE(parts.rects().size(), 6U);
}

TEST(SkyParts, HaveTheSunWhereItIs) {
    const scene::Sun sun = sun_behind();
    const double sun_up_rad = std::asin(sun.direction_to_sun_world.y);
    const double sun_left_rad = std::atan2(-sun.direction_to_sun_world.x, -sun.direction_to_sun_world.z);
    SkyParts parts;
    parts.build(looking(sun_left_rad, sun_up_rad), sun);
    EXPECT_EQ(part_at(parts.rects(), {100, 85}), SkyPart::sun);
    parts.build(looking(sun_left_rad + 1.3, sun_up_rad), sun);
    EXPECT_EQ(part_at(parts.rects(), {100, 85}), SkyPart::glow);
}

using GlSkyParts = test::GlTest;

ColourImage sky_of(SkyPass& pass, const Camera& camera, const scene::Sun& sun, std::span<const SkyRect> rects) {
    const auto targets = std::move(*RenderTargets::create(camera.size_px));
    const shader::FrameBlock block = frame_block(camera, sun);
    const gl::Buffer frame = gl::make_buffer(sizeof block, &block, 0);
    glBindBufferBase(GL_UNIFORM_BUFFER, shader::kBindingFrame, frame.id());
    targets->lit.bind();
    glDisable(GL_DEPTH_TEST);
    pass.draw(rects, camera.size_px);
    ColourImage colour{camera.size_px};
    targets->colour.download(GL_RGBA, GL_UNSIGNED_BYTE, colour.size_bytes(), colour.pixels().data());
    return colour;
}

// What a part leaves out is a thirtieth of a level, so that rounding may differ here and there: in 1 of 30 values if
// all of it was left out everywhere.
TEST_F(GlSkyParts, ShowWhatTheWholeSkyShows) {
    auto pass = SkyPass::create();
    ASSERT_TRUE(pass.ok()) << pass.error().message();
    const scene::Sun sun = sun_behind();
    for (const double left_rad : {0.0, 1.2, 2.2, 3.1}) {
        for (const double up_rad : {-0.5, 0.0, 0.6}) {
            const Camera camera = looking(left_rad, up_rad);
            SkyParts parts;
            parts.build(camera, sun);
            const SkyRect whole{{0, 0}, camera.size_px, SkyPart::sun};
            const ColourImage shown = sky_of(*pass, camera, sun, parts.rects());
            const ColourImage expected = sky_of(*pass, camera, sun, {&whole, 1});
            std::size_t different = 0;
            for (std::size_t i = 0; i < shown.pixels().size(); ++i) {
                const Rgba8 a = shown.pixels()[i];
                const Rgba8 b = expected.pixels()[i];
                const int most = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
                ASSERT_LE(most, 1) << left_rad << ", " << up_rad << ", pixel " << i;
                different += static_cast<std::size_t>(most);
            }
            EXPECT_LE(different, shown.pixels().size() / 20) << left_rad << ", " << up_rad;
        }
    }
}

}  // namespace
}  // namespace lw
