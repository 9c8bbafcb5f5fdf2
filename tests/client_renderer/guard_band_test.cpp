#include "client_renderer/guard_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "client_renderer/source_camera.h"

namespace lw {
namespace {

constexpr double kRadPerDegree = 3.14159265358979323846 / 180.0;

Camera target_camera(double vertical_deg = 90.0, glm::ivec2 size_px = {512, 512}) {
    Camera camera;
    camera.size_px = size_px;
    camera.fov = FovTangents::symmetric(vertical_deg * kRadPerDegree, static_cast<double>(size_px.x) / size_px.y);
    camera.world_from_eye.position_m = {1.0, 2.0, 3.0};
    return camera;
}

// Source pixels from the source's first column and row to the target's.
glm::dvec2 first_target_px(const Camera& source, const Camera& target) {
    const double tan_per_px_x = (source.fov.right - source.fov.left) / source.size_px.x;
    const double tan_per_px_y = (source.fov.up - source.fov.down) / source.size_px.y;
    return {(target.fov.left - source.fov.left) / tan_per_px_x, (source.fov.up - target.fov.up) / tan_per_px_y};
}

TEST(GuardBand, NoneIsTheTarget) { EXPECT_EQ(with_guard_band(target_camera(), 0.0), target_camera()); }

TEST(GuardBand, GridsCoincide) {
    Camera lopsided = target_camera(70.0, {333, 201});
    lopsided.fov = {-1.3, 0.4, -0.7, 1.1};
    for (const Camera& target : {target_camera(), target_camera(60.0, {640, 360}), lopsided}) {
        for (const double band_deg : {0.1, 3.0, 5.0, 10.0, 25.0}) {
            const Camera source = with_guard_band(target, band_deg * kRadPerDegree);
            EXPECT_EQ(source.world_from_eye, target.world_from_eye);
            EXPECT_EQ(source.near_m, target.near_m);
            const double target_tan_per_px = (target.fov.right - target.fov.left) / target.size_px.x;
            const double source_tan_per_px = (source.fov.right - source.fov.left) / source.size_px.x;
            // The pitch is that of the target but for the rounding of doubles.
            EXPECT_NEAR(source_tan_per_px / target_tan_per_px, 1.0, 1e-13) << band_deg;
            const glm::dvec2 first_px = first_target_px(source, target);
            EXPECT_NEAR(first_px.x, std::round(first_px.x), 1e-9) << band_deg;
            EXPECT_NEAR(first_px.y, std::round(first_px.y), 1e-9) << band_deg;
        }
    }
}

TEST(GuardBand, EverySideSeesWhatWasAskedAndLessThanAPixelMore) {
    Camera target = target_camera();
    target.fov = {-1.3, 0.4, -0.7, 1.1};
    const double band_rad = 8.0 * kRadPerDegree;
    const Camera source = with_guard_band(target, band_rad);
    const double tan_per_px_x = (target.fov.right - target.fov.left) / target.size_px.x;
    const double tan_per_px_y = (target.fov.up - target.fov.down) / target.size_px.y;
    const auto expect_side = [&](double target_tan, double source_tan, double tan_per_px) {
        const double asked_tan = std::tan(std::atan(target_tan) + band_rad);
        EXPECT_GE(source_tan, asked_tan - 1e-9);
        EXPECT_LT(source_tan, asked_tan + tan_per_px);
    };
    expect_side(-target.fov.left, -source.fov.left, tan_per_px_x);
    expect_side(target.fov.right, source.fov.right, tan_per_px_x);
    expect_side(-target.fov.down, -source.fov.down, tan_per_px_y);
    expect_side(target.fov.up, source.fov.up, tan_per_px_y);
}

TEST(GuardBand, ASideThatOnlySeesAwayFromTheAxisGrowsToo) {
    Camera target = target_camera();
    target.fov = {0.2, 1.0, -1.0, 1.0};  // a tile to the right of the axis
    const Camera source = with_guard_band(target, 5.0 * kRadPerDegree);
    EXPECT_LT(source.fov.left, std::tan(std::atan(0.2) - 5.0 * kRadPerDegree) + 1e-9);
}

TEST(GuardBand, TheWidestViewEndsIt) {
    const Camera source = with_guard_band(target_camera(160.0), 30.0 * kRadPerDegree);
    EXPECT_NEAR(std::atan(source.fov.right), kWidestHalfAngleRad, 0.01);
    EXPECT_EQ(with_guard_band(target_camera(170.0), 0.1).size_px, glm::ivec2(512, 512));
}

TEST(GuardBand, TwiceThePixelsAreAboutTenDegreesAtNinety) {
    const double widest_rad = widest_guard_band_rad(target_camera(), 2.0);
    EXPECT_NEAR(widest_rad / kRadPerDegree, 9.7, 0.15);  // the diagonal of the doubled view: tan 54.7 degrees = sqrt 2
    const Camera source = with_guard_band(target_camera(), widest_rad);
    EXPECT_LE(pixels_ratio(source, target_camera()), 2.0);
    EXPECT_GT(pixels_ratio(source, target_camera()), 1.97) << "one pixel more per side would be too many";
    EXPECT_EQ(widest_guard_band_rad(target_camera(170.0), 2.0), kWidestHalfAngleRad) << "nothing left to grow";
}

TEST(SourceCamera, DensityMultipliesPixelsAtTheSameView) {
    const Camera target = target_camera(90.0, {301, 200});
    const Camera source = source_camera(target, 1.5, 0.0);
    EXPECT_EQ(source.size_px, glm::ivec2(452, 300));
    EXPECT_EQ(source.fov, target.fov);
    EXPECT_EQ(source_camera(target, 1.0, 0.0), target);
    const Camera banded = with_guard_band(target, 0.1);
    EXPECT_EQ(source_camera(target, 2.0, 0.1).fov, banded.fov);
    EXPECT_EQ(source_camera(target, 2.0, 0.1).size_px, 2 * banded.size_px);
}

/// A head that turns about the vertical at a speed that the test sets, sampled every millisecond.
class TurningHead final : public HeadPoseFeed {
public:
    [[nodiscard]] std::size_t newest(TimePoint now, std::span<PoseSample> samples) const override {
        const auto newest = now.time_since_epoch() / std::chrono::milliseconds{1};
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const auto number = newest - static_cast<std::int64_t>(i);
            const double angle_rad = rad_per_s * 1e-3 * static_cast<double>(number);
            samples[i] = {TimePoint{std::chrono::milliseconds{number}},
                          {{}, glm::angleAxis(angle_rad, glm::dvec3{0.0, 1.0, 0.0})},
                          static_cast<std::uint64_t>(number) + 1};
        }
        return samples.size();
    }
    double rad_per_s = 0.0;
};

class GuardBandSizerTest : public testing::Test {
protected:
    // Degrees of the next frame's band at a speed, a frame being shown until 200 ms after its drawing began.
    double next_deg(double deg_per_s) {
        head_.rad_per_s = deg_per_s * kRadPerDegree;
        return sizer_.next_rad(head_, at_seconds(10.0), from_ms(200.0)) / kRadPerDegree;
    }
    TurningHead head_;
    GuardBandSizer sizer_{target_camera()};
};

TEST_F(GuardBandSizerTest, AStillHeadNeedsNone) { EXPECT_EQ(next_deg(0.0), 0.0); }

TEST_F(GuardBandSizerTest, FasterTurnsTakeTheNextStep) {
    const double widest_deg = widest_guard_band_rad(target_camera(), 2.0) / kRadPerDegree;
    EXPECT_NEAR(next_deg(20.0), 0.5 * widest_deg, 1e-9);  // 4 degrees in 200 ms
    EXPECT_NEAR(next_deg(30.0), widest_deg, 1e-9);        // 6 degrees
    EXPECT_NEAR(next_deg(500.0), widest_deg, 1e-9);       // there is no more
}

TEST_F(GuardBandSizerTest, ItShrinksLaterAndStepByStep) {
    const double widest_deg = next_deg(30.0);
    EXPECT_EQ(next_deg(20.0), widest_deg) << "half of the band would do, and just so";
    EXPECT_EQ(next_deg(30.0), widest_deg);
    EXPECT_NEAR(next_deg(0.0), 0.5 * widest_deg, 1e-9);
    EXPECT_EQ(next_deg(0.0), 0.0);
}

TEST_F(GuardBandSizerTest, OlderFramesNeedMore) {
    head_.rad_per_s = 20.0 * kRadPerDegree;
    GuardBandSizer other{target_camera()};
    EXPECT_LT(sizer_.next_rad(head_, at_seconds(10.0), from_ms(100.0)),
              other.next_rad(head_, at_seconds(10.0), from_ms(300.0)));
}

TEST(SourceCameras, AGivenBandStays) {
    TurningHead head;
    SourceCameras cameras{target_camera(), {1, 2.0, 0.1}};
    for (const double rad_per_s : {0.0, 3.0}) {
        head.rad_per_s = rad_per_s;
        EXPECT_EQ(cameras.next(head, at_seconds(10.0), from_ms(200.0)), source_camera(target_camera(), 2.0, 0.1));
    }
    EXPECT_EQ(cameras.largest(), source_camera(target_camera(), 2.0, 0.1));
}

TEST(SourceCameras, AnAutomaticBandFollowsTheHead) {
    TurningHead head;
    SourceCameras cameras{target_camera(), {1, 1.0, std::nullopt}};
    EXPECT_EQ(cameras.next(head, at_seconds(10.0), from_ms(200.0)), target_camera());
    head.rad_per_s = 3.0;
    EXPECT_EQ(cameras.next(head, at_seconds(10.0), from_ms(200.0)), cameras.largest());
}

}  // namespace
}  // namespace lw
