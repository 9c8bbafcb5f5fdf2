/// Wires, railings and posts about a pixel wide stay where they belong and do not break.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/reprojection.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/synthetic_layers.h"

namespace lw::test {
namespace {

// 512 pixels over 90 degrees: the street's wires, bars and posts are 0.7 to 4 px wide.
constexpr int kSide_px = 512;
constexpr float kSameDepth = 0.03F;

bool is_thin(const Solid& solid) { return std::min(solid.half_size_m.x, solid.half_size_m.y) < 0.025; }

// Whether a pixel of `image` within 1 px of `place` fulfils the condition.
template <class Condition>
bool within_one_px(glm::ivec2 size_px, glm::ivec2 place, Condition condition) {
    for (int y = std::max(place.y - 1, 0); y <= std::min(place.y + 1, size_px.y - 1); ++y) {
        for (int x = std::max(place.x - 1, 0); x <= std::min(place.x + 1, size_px.x - 1); ++x) {
            if (condition(x, y)) return true;
        }
    }
    return false;
}

struct ThinCase {
    glm::dvec3 offset_m;
    double yaw_deg;
    double pitch_deg;
};

struct Found {
    int pixels = 0;  // of the truth that show a thin thing which the source shows too
    int found = 0;   // the same thing's depth within 1 px in the picture shown

    [[nodiscard]] double share() const { return static_cast<double>(found) / std::max(pixels, 1); }
};

Found find_thin_things(const AnalyticScene& scene, const Layer& layer, const Camera& target,
                       const DisplayFrame& shown) {
    const Image<int> at_target = scene.solid_at(target, 0.0);
    const Image<int> at_source = scene.solid_at(layer.camera, 0.0);
    const DepthImage depth = scene.truth_depth(target, 0.0);
    const auto source_from_target = static_target_px_from_source_px(target, layer.camera);
    Found result;
    for (int y = 0; y < depth.height(); ++y) {
        for (int x = 0; x < depth.width(); ++x) {
            const int solid = at_target.at(x, y);
            if (solid < 0 || !is_thin(scene.solids[static_cast<std::size_t>(solid)])) continue;
            const auto place = reproject(source_from_target, {x + 0.5, y + 0.5}, depth.at(x, y));
            if (!place) continue;
            const glm::ivec2 size_px = layer.camera.size_px;
            const bool in_source = within_one_px(size_px, glm::ivec2{glm::floor(place->position_px)},
                                                 [&](int sx, int sy) { return at_source.at(sx, sy) == solid; });
            if (!in_source) continue;
            ++result.pixels;
            const float expected = depth.at(x, y);
            const bool found = within_one_px(target.size_px, {x, y}, [&](int sx, int sy) {
                return shown.coverage.at(sx, sy) == Coverage::reached &&
                       std::abs(shown.depth.at(sx, sy) - expected) <= kSameDepth * expected;
            });
            result.found += found ? 1 : 0;
        }
    }
    return result;
}

TEST(ThinThings, AreWithinOnePixelOfTheirPlaceInNineOfTenPixels) {
    const AnalyticScene scene = AnalyticScene::street();
    const Camera source = street_camera({kSide_px, kSide_px});
    const ThinCase cases[] = {
        {{0.005, 0.002, -0.004}, 0.5, 0.2}, {{0.03, 0.01, -0.03}, 2.0, 1.0}, {{-0.06, 0.02, 0.05}, -4.0, -2.0}};
    for (const int samples : {1, 2}) {
        const Layer layer = scene.draw(source, 0.0, samples);
        for (const ThinCase& test : cases) {
            const Camera target = moved(source, test.offset_m, test.yaw_deg, test.pitch_deg);
            for (const char* method : {"surface", "splat"}) {
                const Found found = find_thin_things(scene, layer, target, warp_once(method, layer, {target, {}}));
                std::printf("%s, %d samples, %.1f deg: %d of %d thin pixels, %.3f\n", method, samples, test.yaw_deg,
                            found.found, found.pixels, found.share());
                ASSERT_GT(found.pixels, 1000);
                EXPECT_GE(found.share(), 0.9) << method;
            }
        }
    }
}

}  // namespace
}  // namespace lw::test
