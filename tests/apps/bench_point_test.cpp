/// Points of the warp suite: fronts, files, the plan.

#include "apps/bench_point.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "apps/warp_sweep_plan.h"
#include "apps/warp_sweep_report.h"
#include "apps/warp_sweep_run.h"
#include "tests/apps/program.h"
#include "warp_server/fill.h"
#include "warp_server/methods/registry.h"

namespace lw::test {

namespace {

using testing::HasSubstr;
using testing::Not;

BenchPoint point(const std::string& method, double ms, double flip, BenchConditions conditions = {}) {
    BenchPoint made;
    made.method = method;
    made.fill = "nearest-background";
    made.conditions = conditions;
    made.warp_ms = Distribution{ms, ms, ms, ms, ms, ms, ms};
    made.warp_cpu_ms = ms;
    made.memcpy_ratio = 2 * ms;
    made.pairs = {{"city", "walk", {flip, 0.9, 30.0, 0.05}}};
    return made;
}

TEST(ParetoFront, IsWhatNothingBeatsInBoth) {
    std::vector<BenchPoint> points = {point("fast", 1, 0.3),  point("both", 2, 0.1),         point("slow", 3, 0.2),
                                      point("best", 9, 0.05), point("same as both", 2, 0.1), point("slower", 2.5, 0.1)};
    mark_pareto_fronts(points);
    std::vector<bool> on_front;
    for (const BenchPoint& each : points) on_front.push_back(*each.on_front);
    EXPECT_THAT(on_front, testing::ElementsAre(true, true, false, true, true, false));
}

TEST(ParetoFront, JoinsEqualConditionsOnly) {
    BenchConditions older;
    older.frame_age_ms = 200;
    std::vector<BenchPoint> points = {point("good", 1, 0.1), point("bad", 2, 0.2, older)};
    mark_pareto_fronts(points);
    EXPECT_TRUE(*points[1].on_front);
}

TEST(ParetoFront, LeavesOutPointsThatWereNotMeasured) {
    std::vector<BenchPoint> points = {point("fast", 1, 0.3), point("no time", 0.1, 0.1), point("no errors", 0.1, 0.1)};
    points[1].warp_ms.reset();
    points[2].pairs.clear();
    mark_pareto_fronts(points);
    EXPECT_TRUE(*points[0].on_front);
    EXPECT_FALSE(points[1].on_front.has_value());
    EXPECT_FALSE(points[2].on_front.has_value());
}

TEST(BenchPoint, ErrorsAreMeansOverPairsAndEqualPicturesHaveNoPsnr) {
    BenchPoint made = point("a", 1, 0.1);
    made.pairs.push_back({"room", "walk", {0.3, 0.7, std::nullopt, 0.15}});
    const ImageErrors errors = *made.errors();
    EXPECT_DOUBLE_EQ(errors.flip, 0.2);
    EXPECT_DOUBLE_EQ(errors.ssim, 0.8);
    EXPECT_DOUBLE_EQ(*errors.psnr_db, 30.0);
    EXPECT_DOUBLE_EQ(errors.hole_fraction, 0.1);
}

Report report_of(const std::vector<BenchPoint>& points) {
    Report report{Subcommand::bench};
    report.set("suite", "warp");
    describe_machine(report, Machine{"some processor", 4, "some renderer", "4.5"});
    add_points(report, points);
    return report;
}

TEST(BenchReport, HoldsTheKeysThatScriptsRead) {
    std::vector<BenchPoint> points = {point("points:size_px=2", 1, 0.1)};
    mark_pareto_fronts(points);
    const auto json = nlohmann::json::parse(report_of(points).text());
    EXPECT_EQ(json.at("schema"), "latewarp.bench/1");
    EXPECT_EQ(json.at("machine").at("cores"), 4);
    const auto& entry = json.at("points").at(0);
    EXPECT_EQ(entry.at("method"), "points:size_px=2");
    EXPECT_EQ(entry.at("size_px"), nlohmann::json::parse("[512, 512]"));
    for (const char* key : {"mean", "min", "p5", "p50", "p95", "p99", "max"}) {
        EXPECT_TRUE(entry.at("warp_ms").at(key).is_number()) << key;
    }
    for (const char* key : {"memcpy_ratio", "flip", "ssim", "psnr_db", "hole_fraction"}) {
        EXPECT_TRUE(entry.at(key).is_number()) << key;
    }
    EXPECT_EQ(entry.at("on_front"), true);
    for (const char* key : {"fill", "frame_age_ms", "source_samples", "source_density"}) {
        EXPECT_TRUE(entry.at("settings").contains(key)) << key;
    }
}

TEST(BenchReport, ReadsBackAsItWasWritten) {
    BenchConditions conditions{{1024, 512}, 50.0, 2, 1.5};
    std::vector<BenchPoint> points = {point("splat", 1.25, 0.1), point("surface", 2.5, 0.05, conditions)};
    mark_pareto_fronts(points);
    points[0].pairs[0].mean.psnr_db.reset();
    points[1].prepare_ms = 3.5;
    const auto file = fresh_folder("bench_report") / "report.json";
    ASSERT_TRUE(report_of(points).write(file));
    const auto data = load_bench_data(file);
    ASSERT_TRUE(data) << data.error().message();
    EXPECT_EQ(data->machine.cpu, "some processor");
    EXPECT_EQ(data->machine.gl_renderer, "some renderer");
    ASSERT_EQ(data->points.size(), 2u);
    EXPECT_EQ(report_of(data->points).text(), report_of(points).text());
}

TEST(BenchReport, AnythingElseIsAnErrorThatNamesTheMend) {
    const auto folder = fresh_folder("bad_bench_reports");
    int number = 0;
    for (const std::string text :
         {"", "{", "[]", "{\"schema\": \"latewarp.bench/1\"}", "{\"schema\": \"latewarp.replay/1\"}",
          "{\"schema\": \"latewarp.bench/1\", \"suite\": \"warp\", \"machine\": 3}"}) {
        const auto file = folder / fmt::format("{}.json", number++);
        write_text_file(file, text);
        const auto data = load_bench_data(file);
        ASSERT_FALSE(data) << text;
        EXPECT_THAT(data.error().message(), HasSubstr("latewarp bench --quick"));
    }
    write_text_file(folder / "deep.json", std::string(100000, '['));
    EXPECT_FALSE(load_bench_data(folder / "deep.json"));
    EXPECT_FALSE(load_bench_data(folder / "missing.json"));
}

TEST(SweepPlan, VariesEveryFactorAroundOneBase) {
    const SweepPlan plan = warp_sweep_plan(false, "/nowhere");
    std::set<int> sizes_px;
    std::set<double> ages_ms;
    std::set<int> samples;
    std::set<double> densities;
    std::set<std::string> methods;
    std::set<std::string> fills;
    for (const SweepCell& cell : plan.cells) {
        sizes_px.insert(cell.conditions.size_px.x);
        ages_ms.insert(cell.conditions.frame_age_ms);
        samples.insert(cell.conditions.source_samples);
        densities.insert(cell.conditions.source_density);
        EXPECT_GE(cell.pairs, plan.core_pairs);
        EXPECT_LE(cell.pairs, plan.pairs.size());
        EXPECT_GE(cell.frames, 1u);
        for (const WarpSetting& setting : cell.settings) {
            methods.insert(setting.method.substr(0, setting.method.find(':')));
            fills.insert(setting.fill);
            EXPECT_TRUE(find_warp_method(setting.method) != nullptr) << setting.method;
        }
    }
    EXPECT_THAT(sizes_px, testing::ElementsAre(512, 1024, 2048));
    EXPECT_THAT(ages_ms, testing::ElementsAre(20, 50, 100, 200));
    EXPECT_THAT(samples, testing::ElementsAre(1, 2, 4));
    EXPECT_THAT(densities, testing::ElementsAre(1.0, 1.5, 2.0));
    EXPECT_EQ(fills.size(), fill_names().size());
    for (const MethodEntry& entry : warp_methods()) {
        if (entry.name == "reference") continue;  // the oracle of the tests, a thousand times slower
        EXPECT_EQ(methods.count(std::string{entry.name}), 1u) << entry.name;
    }
}

TEST(SweepPlan, IsAFractionOfTheProductAndQuickIsAFractionOfThat) {
    const SweepPlan plan = warp_sweep_plan(false, "/nowhere");
    const SweepPlan quick = warp_sweep_plan(true, "/nowhere");
    // 3 sizes x 4 ages x 3 samples x 3 densities x 17 methods x fills is the whole product.
    EXPECT_LT(plan.point_count(), 3u * 4u * 3u * 3u * 17u * fill_names().size() / 10u);
    EXPECT_GT(plan.point_count(), 200u);
    EXPECT_LT(quick.judgement_count() * 5, plan.judgement_count());
    EXPECT_EQ(points_of(plan).size(), plan.point_count());
    EXPECT_EQ(points_of(quick).size(), quick.point_count());
}

TEST(SweepPlan, HasNoPointTwice) {
    for (const bool quick : {false, true}) {
        const std::vector<BenchPoint> points = points_of(warp_sweep_plan(quick, "/nowhere"));
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t k = i + 1; k < points.size(); ++k) {
                EXPECT_FALSE(points[i].method == points[k].method && points[i].fill == points[k].fill &&
                             points[i].conditions == points[k].conditions)
                    << points[i].method << " " << text_of(points[i].conditions);
            }
        }
    }
}

TEST(SweepPlan, WithoutRecordingsWarnsOnceAndTakesBuiltInTraces) {
    const SweepPlan plan = warp_sweep_plan(true, "/nowhere");
    ASSERT_EQ(plan.warnings.size(), 1u);
    EXPECT_THAT(plan.warnings.front(), HasSubstr("--data"));
    for (const SweepPair& pair : plan.pairs) EXPECT_EQ(pair.scene, "city");
}

TEST(SweepPlan, PicturesDependOnEverySettingButThreads) {
    EXPECT_EQ(picture_label("splat"), "splat");
    EXPECT_EQ(picture_label("splat:threads=2"), "splat");
    EXPECT_EQ(picture_label("points:size_px=2"), "points:size_px=2");
    EXPECT_EQ(picture_label("x:a=1,threads=2,b=3"), "x:a=1,b=3");
}

TEST(SweepReport, DrawsFrontsAgesAndSizes) {
    const SweepPlan plan = warp_sweep_plan(true, "/nowhere");
    std::vector<BenchPoint> points = points_of(plan);
    double ms = 1.0;
    for (BenchPoint& each : points) {
        ms += 0.1;
        const BenchPoint made = point(each.method, ms, 0.5 / ms, each.conditions);
        each.warp_ms = made.warp_ms;
        each.pairs = made.pairs;
    }
    mark_pareto_fronts(points);
    const FreshErrors fresh{{512, 512}, 1, {{"city", "walk", {0.08, 0.9, 30.0, 0.0}}}};
    const auto plots = warp_sweep_plots(plan, points, {fresh});
    std::set<std::string> names;
    for (const auto& [name, plot] : plots) names.insert(name);
    EXPECT_EQ(names.count("age"), 1u);
    EXPECT_EQ(names.count("size"), 1u);
    EXPECT_EQ(names.count("front-512px-100ms-2x2-density1"), 1u);
    const std::string html = warp_sweep_page(plan, points, plots, "a <machine>").text();
    EXPECT_THAT(html, HasSubstr("a &lt;machine&gt;"));
    EXPECT_THAT(html, Not(HasSubstr("http")));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
    const std::string csv = warp_sweep_csv(points);
    EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')), 1 + 2 * points.size());
}

}  // namespace

}  // namespace lw::test
