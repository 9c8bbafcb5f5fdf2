/// The warp suite at work, on small pictures.

#include <gtest/gtest.h>

#include "apps/warp_sweep_run.h"
#include "apps/warp_sweep_stage.h"
#include "tests/support/gl_test.h"
#include "tests/support/shared_data.h"

namespace lw::test {

namespace {

SweepPlan small_plan() {
    SweepPlan plan;
    plan.pairs = {{"city", "walk", 5.0, "city", "walk"}};
    plan.core_pairs = 1;
    plan.truth_samples = 2;
    const std::vector<WarpSetting> settings = {
        {"stale", "none"}, {"mesh", "none"}, {"splat", "none"}, {"splat:threads=2", "none"}, {"surface", "none"}};
    plan.cells = {{{{64, 48}, 100.0, 1, 1.0}, settings, 1, 2}, {{{64, 48}, 100.0, 2, 1.0}, settings, 1, 2}};
    return plan;
}

constexpr SweepSettings kQuiet{0, true};

TEST(GlWarpSweep, ErrorsAreCompleteAndRepeatable) {
    LW_NEED_GL();
    const SweepPlan plan = small_plan();
    std::vector<BenchPoint> points = points_of(plan);
    std::vector<BenchPoint> again = points_of(plan);
    const auto fresh = measure_errors(plan, kQuiet, points);
    ASSERT_TRUE(fresh) << fresh.error().message();
    ASSERT_TRUE(measure_errors(plan, kQuiet, again));
    for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(points[i].pairs.size(), 1u);
        EXPECT_EQ(points[i].errors()->flip, again[i].errors()->flip) << points[i].method;
        EXPECT_EQ(points[i].errors()->ssim, again[i].errors()->ssim) << points[i].method;
    }
    // The order of small_plan(): a GL method in it must not change what is drawn after it.
    EXPECT_GT(points[0].errors()->flip, points[4].errors()->flip) << "a stale picture is worse than a warped one";
    EXPECT_EQ(points[2].errors()->flip, points[3].errors()->flip) << "threads change no pixel";
    ASSERT_EQ(fresh->size(), 2u);
    for (const FreshErrors& each : *fresh) {
        EXPECT_EQ(each.size_px, (glm::ivec2{64, 48}));
        EXPECT_LT(each.pairs.at(0).mean.flip, points[0].errors()->flip);
    }
    EXPECT_GT(fresh->at(0).pairs.at(0).mean.flip, fresh->at(1).pairs.at(0).mean.flip) << "2x2 samples are the truth's";
}

TEST(GlWarpSweep, TimesAreTakenOnceAndSharedOverSamples) {
    LW_NEED_GL();
    const SweepPlan plan = small_plan();
    std::vector<BenchPoint> points = points_of(plan);
    const Distribution known{7, 7, 7, 7, 7, 7, 7};
    points[0].warp_ms = known;
    SweepSettings settings = kQuiet;
    settings.most_s = -1.0;
    ASSERT_TRUE(measure_times(plan, settings, 2, points));
    EXPECT_FALSE(points[1].warp_ms) << "no time is begun after the limit";
    ASSERT_TRUE(measure_times(plan, kQuiet, 2, points));
    EXPECT_EQ(*points[0].warp_ms, known);
    for (std::size_t i = 1; i < 5; ++i) {
        ASSERT_TRUE(points[i].warp_ms) << points[i].method;
        EXPECT_GT(*points[i].memcpy_ratio, 0.0);
        EXPECT_EQ(*points[i].warp_ms, *points[i + 5].warp_ms) << points[i].method;
    }
    for (std::size_t i = 0; i < 5; ++i) {
        const std::string& method = points[i].method;
        const bool prepares = method.rfind("splat", 0) == 0 || method.rfind("surface", 0) == 0;
        EXPECT_EQ(points[i].prepare_ms.has_value(), prepares) << method;
    }
}

TEST(DataWarpSweep, EverySceneAndTraceOfThePlanCanBeDrawn) {
    LW_NEED_SHARED_DATA();
    LW_NEED_GL();
    const SweepPlan plan = warp_sweep_plan(true, shared_data_dir());
    EXPECT_TRUE(plan.warnings.empty());
    ASSERT_EQ(plan.pairs.size(), 3u);
    EXPECT_EQ(warp_sweep_plan(false, shared_data_dir()).pairs.size(), 9u);
    std::optional<SweepStage> stage;
    for (const SweepPair& pair : plan.pairs) {
        auto made = SweepStage::create(pair, std::exchange(stage, std::nullopt));
        ASSERT_TRUE(made) << made.error().message();
        stage = *std::move(made);
        const auto layer = stage->source({{64, 64}, 100.0, 1, 1.0}, photon_s_of(plan, 0));
        // A view of nothing but sky would say nothing about a warp.
        const auto& depth = layer->cpu().depth.pixels();
        const auto covered = std::count_if(depth.begin(), depth.end(), [](float each) { return each > 0.0F; });
        EXPECT_GT(static_cast<double>(covered), 0.2 * static_cast<double>(depth.size())) << pair.scene_label;
    }
}

}  // namespace

}  // namespace lw::test
