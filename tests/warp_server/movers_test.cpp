/// Moving objects are shown as well as standing ones: where the source saw their surface, only the sampling differs.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/metrics.h"
#include "core/reprojection.h"
#include "tests/warp_server/analytic_scene.h"
#include "tests/warp_server/synthetic_layers.h"
#include "warp_server/fill.h"

namespace lw::test {
namespace {

constexpr int kSide_px = 256;

// The street with everything as it stands at `time_s`, for ever.
AnalyticScene frozen(AnalyticScene scene, double time_s) {
    for (Solid& solid : scene.solids) {
        solid.position_m += time_s * solid.velocity_m_s;
        solid.turn_rad += time_s * solid.spin_rad_s;
        solid.velocity_m_s = glm::dvec3{0.0};
        solid.spin_rad_s = 0.0;
    }
    return scene;
}

// The street without its railing, whose bars uncover more of a box that moves behind them than of one that stands.
AnalyticScene street_of_boxes() {
    AnalyticScene scene = AnalyticScene::street();
    std::erase_if(scene.solids, [](const Solid& solid) {
        return std::min({solid.half_size_m.x, solid.half_size_m.y, solid.half_size_m.z}) < 0.03;
    });
    return scene;
}

// Mean FLIP over the pixels that `mask` marks; errors elsewhere do not reach into them.
double flip_in(const ColourImage& truth, ColourImage shown, double ppd, const Image<std::uint8_t>& mask) {
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        if (mask.pixels()[i] == 0) shown.pixels()[i] = truth.pixels()[i];
    }
    const Image<float> errors = flip(truth, shown, ppd).error_map;
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        if (mask.pixels()[i] == 0) continue;
        sum += static_cast<double>(errors.pixels()[i]);
        ++count;
    }
    EXPECT_GT(count, 100);
    return sum / std::max(count, 1);
}

// Target pixels of the object whose surface the source saw.
Image<std::uint8_t> seen_pixels_of(ObjectId id, const AnalyticScene& scene, const Camera& target, double target_time_s,
                                   const Camera& source, double source_time_s) {
    Image<std::uint8_t> mask = scene.seen_by_source(target, target_time_s, source, source_time_s);
    const Image<int> solids = scene.solid_at(target, target_time_s);
    for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
        const int solid = solids.pixels()[i];
        if (solid < 0 || scene.solids[static_cast<std::size_t>(solid)].id != id) mask.pixels()[i] = 0;
    }
    return mask;
}

ColourImage shown_by(const char* method, const Layer& layer, const Camera& target,
                     const std::vector<ObjectTransform>& movers) {
    DisplayFrame frame = warp_once(method, layer, {target, movers});
    (*make_fill("pyramid"))->apply(frame, fill_guide(layer.camera, target));
    return frame.colour;
}

// How much the surface at each target pixel is magnified against the source, as an area: large where a face is seen
// askance in the source and frontally in the target.
Image<float> magnification(const AnalyticScene& scene, const Camera& target, double target_time_s, const Camera& source,
                           double source_time_s) {
    const DepthImage depth = scene.truth_depth(target, target_time_s);
    const Image<int> solids = scene.solid_at(target, target_time_s);
    ReprojectionTable table;
    const std::vector<ObjectTransform> at_target = scene.movers(target_time_s);
    const std::vector<ObjectTransform> at_source = scene.movers(source_time_s);
    table.build(target, source, at_target, at_source);
    Image<float> result{target.size_px, 1.0F};
    for (int y = 0; y + 1 < depth.height(); ++y) {
        for (int x = 0; x + 1 < depth.width(); ++x) {
            const int solid = solids.at(x, y);
            const bool inner = solid >= 0 && solids.at(x + 1, y) == solid && solids.at(x, y + 1) == solid;
            if (!inner) continue;
            const auto* source_from_target = table.find(scene.solids[static_cast<std::size_t>(solid)].id);
            const auto at = [&](int dx, int dy) {
                return reproject(*source_from_target, {x + dx + 0.5, y + dy + 0.5}, depth.at(x + dx, y + dy))
                    ->position_px;
            };
            const glm::dvec2 u = at(1, 0) - at(0, 0);
            const glm::dvec2 v = at(0, 1) - at(0, 0);
            result.at(x, y) = static_cast<float>(1.0 / std::max(1e-6, std::abs(u.x * v.y - u.y * v.x)));
        }
    }
    return result;
}

struct Errors {
    double moving = 0.0;
    double still = 0.0;

    [[nodiscard]] double ratio() const { return moving / still; }
};

// Mean FLIP of the box over eight phases of its motion, each seen 50 ms earlier and 50 ms later than it was drawn for:
// a frame is drawn for the middle of its life of 100 ms. Pixels magnified by more than `most_magnified` are left out.
Errors errors_of_box(ObjectId id, const char* method, double most_magnified) {
    const AnalyticScene moving = street_of_boxes();
    const Camera source = street_camera({kSide_px, kSide_px});
    const Camera target = moved(source, {0.01, 0.004, -0.008}, 1.0, 0.5);
    const double ppd = pixels_per_degree(target);
    Errors errors;
    for (int phase = 0; phase < 8; ++phase) {
        const double time_s = (id == 1 ? 0.04 : 0.125) * phase;  // a slide that stays in view; a whole turn
        const AnalyticScene still = frozen(moving, time_s);
        const ColourImage truth = moving.truth(target, time_s, 3);
        const Layer of_still = still.draw(source, 0.0, 2);
        const ColourImage shown_still = shown_by(method, of_still, target, still.movers(0.0));
        for (const double age_s : {-0.05, 0.05}) {
            const Layer of_moving = moving.draw(source, time_s - age_s, 2);
            Image<std::uint8_t> mask = seen_pixels_of(id, moving, target, time_s, source, time_s - age_s);
            const Image<float> magnified = magnification(moving, target, time_s, source, time_s - age_s);
            for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
                if (static_cast<double>(magnified.pixels()[i]) > most_magnified) mask.pixels()[i] = 0;
            }
            errors.moving += flip_in(truth, shown_by(method, of_moving, target, moving.movers(time_s)), ppd, mask) / 16;
            errors.still += flip_in(truth, shown_still, ppd, mask) / 16;
        }
    }
    std::printf("%s, box %d, magnified at most %.1f times: FLIP %.4f, standing still %.4f, ratio %.2f\n", method, id,
                most_magnified, errors.moving, errors.still, errors.ratio());
    return errors;
}

constexpr ObjectId kSliding = 1;   // 2 m/s
constexpr ObjectId kSpinning = 2;  // 360 degrees/s
constexpr double kAnyMagnification = 1e9;

TEST(MovingBoxes, ASlidingBoxIsShownAsWellAsOneThatStandsStill) {
    EXPECT_LE(errors_of_box(kSliding, "surface", kAnyMagnification).ratio(), 1.2);
}

TEST(MovingBoxes, ASpinningBoxIsShownNearlyAsWellAsOneThatStandsStill) {
    // Within 50 ms the box turns by 18 degrees. A face that the source saw askance has few pixels there, whatever the
    // method: what was magnified more than twice is not asked for.
    EXPECT_LE(errors_of_box(kSpinning, "surface", 2.0).ratio(), 1.2);
    // With them 1.21 was measured over eight phases.
    EXPECT_LE(errors_of_box(kSpinning, "surface", kAnyMagnification).ratio(), 1.3);
}

TEST(MovingBoxes, WithoutItsPlacementWouldBeFarOff) {
    // The same figure catches a method that forgets that objects move.
    const AnalyticScene moving = street_of_boxes();
    const Camera source = street_camera({kSide_px, kSide_px});
    const Camera target = moved(source, {0.01, 0.004, -0.008}, 1.0, 0.5);
    const ColourImage truth = moving.truth(target, 0.0, 3);
    const Layer layer = moving.draw(source, -0.05, 2);
    const Image<std::uint8_t> mask = seen_pixels_of(1, moving, target, 0.0, source, -0.05);
    const double with = flip_in(truth, shown_by("surface", layer, target, moving.movers(0.0)), 2.8, mask);
    const double without = flip_in(truth, shown_by("surface", layer, target, {}), 2.8, mask);
    EXPECT_GT(without, 2.0 * with);
}

}  // namespace
}  // namespace lw::test
