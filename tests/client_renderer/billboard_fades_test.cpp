// Old and new versions of billboards, shown together while the new one comes in.
#include <cmath>

#include "tests/client_renderer/billboard_fixture.h"

namespace lw {
namespace {

using namespace test;

class GlBillboardFades : public GlBillboards {};

TEST_F(GlBillboardFades, AFadeEndsInTheNewVersion) {
    const scene::Scene scene = few_chairs();
    const Camera camera = outside(scene);
    const Camera later = moved(camera, {0.6, 0.0, 0.0});
    BillboardSettings settings = with_mode(BillboardMode::flat);
    settings.fade_frames = 3;
    settings.error_cap_px = 0.01;
    auto renderer = make(scene, settings);
    (void)draw(*renderer, camera);
    const CpuPixels before = draw(*renderer, camera);
    std::vector<double> likeness;
    for (int frame = 0; frame < 6; ++frame) likeness.push_back(ssim(before.colour, draw(*renderer, later).colour));
    BillboardSettings at_once = with_mode(BillboardMode::flat);
    auto other = make(scene, at_once);
    (void)draw(*other, later);
    // Slots differ, and with them how the rasteriser rounds an edge pixel here and there.
    EXPECT_GT(ssim(draw(*renderer, later).colour, draw(*other, later).colour), 0.999) << "nothing old is left";
    EXPECT_EQ(likeness[4], likeness[5]);
}

/// Low enough for some of the objects to stand before the sky.
Camera before_the_sky(const scene::Scene& scene) {
    Camera camera = outside(scene);
    camera.world_from_eye.position_m.y = 0.6;
    camera.world_from_eye.orientation = glm::angleAxis(0.05, glm::dvec3{1.0, 0.0, 0.0});
    return camera;
}

// Of 3 frames the first has half of the new version over the old one, the third half of the old one where the new one
// is not.
TEST_F(GlBillboardFades, InTheMiddleOfAFadePixelsAreBetweenOldAndNew) {
    const scene::Scene scene = few_chairs();
    const Camera camera = before_the_sky(scene);
    const Camera later = moved(camera, {0.8, 0.2, 0.0});
    for (const BillboardMode mode : {BillboardMode::flat, BillboardMode::warped}) {
        BillboardSettings settings = with_mode(mode);
        settings.error_cap_px = 1000.0;
        auto kept = make(scene, settings);
        (void)draw(*kept, camera);
        const ColourImage before = draw(*kept, later).colour;

        settings.fade_frames = 3;
        settings.error_cap_px = 0.01;
        auto renderer = make(scene, settings);
        (void)draw(*renderer, camera);
        std::vector<ColourImage> fade;
        for (int frame = 0; frame < 4; ++frame) fade.push_back(draw(*renderer, later).colour);
        const ColourImage& after = fade.back();
        EXPECT_EQ(after, draw(*renderer, later).colour) << "the fade is over";

        const glm::ivec2 size_px = before.size_px();
        std::size_t changing = 0;
        std::size_t blended = 0;
        std::size_t wrong[2] = {};
        for (int y = 0; y < size_px.y; ++y) {
            for (int x = 0; x < size_px.x; ++x) {
                const glm::vec3 a = levels(before.at(x, y));
                const glm::vec3 b = levels(after.at(x, y));
                const glm::vec3 half = 0.5f * (a + b);
                if (most_off(before.at(x, y), b) > 8) ++changing;
                // New over old; what only the old version covers is as it was.
                const bool is_half = most_off(fade[0].at(x, y), half) <= 2;
                if (is_half && most_off(before.at(x, y), b) > 8) ++blended;
                if (!is_half && most_off(fade[0].at(x, y), a) > 2) ++wrong[0];
                // What the new version covers is as it will be; the old one goes elsewhere.
                if (most_off(fade[2].at(x, y), b) > 2 && most_off(fade[2].at(x, y), half) > 2) ++wrong[1];
            }
        }
        EXPECT_GT(changing, 300U);
        EXPECT_GT(blended, changing / 3);
        // Where objects overlap, one that fades lies over another that does.
        EXPECT_LE(wrong[0], changing / 20);
        EXPECT_LE(wrong[1], changing / 20);
    }
}

// Light of sun, sky and a lamp is worked out in two places: in the G-buffer, and where it is blended. Levels differ by
// the rounding of the G-buffer.
TEST_F(GlBillboardFades, AFadeBetweenEqualVersionsShowsNothing) {
    scene::Scene scene = few_chairs();
    const Camera camera = before_the_sky(scene);
    scene::PointLight lamp;
    lamp.position_world = camera.world_from_eye.position_m + glm::dvec3{0.0, 1.0, -8.0};
    lamp.range_m = 20.0f;
    lamp.intensity = glm::vec3{40.0f};
    scene.point_lights.push_back(lamp);
    BillboardSettings settings = with_mode(BillboardMode::warped);
    settings.fade_frames = 5;
    settings.error_cap_px = 1e-6;
    auto renderer = make(scene, settings);
    (void)draw(*renderer, camera);
    const Camera later = moved(camera, {1e-4, 0.0, 0.0});
    std::vector<ColourImage> fade;
    for (int frame = 0; frame < 7; ++frame) {
        fade.push_back(draw(*renderer, later).colour);
        EXPECT_EQ(renderer->billboards()->counters().updated, frame == 0 ? 13U : 0U);
    }
    for (const ColourImage& shown : fade) {
        std::size_t different = 0;
        for (std::size_t i = 0; i < shown.pixels().size(); ++i) {
            if (most_off(shown.pixels()[i], levels(fade.back().pixels()[i])) > 2) ++different;
        }
        EXPECT_LE(different, shown.pixels().size() / 2000) << "outlines that two slots round differently";
    }
}

}  // namespace
}  // namespace lw
