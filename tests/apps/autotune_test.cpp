/// --method auto: what it picks from made-up measurements, and what it says when there are none.

#include "apps/autotune.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace lw::test {

namespace {

using testing::HasSubstr;

BenchPoint point(const std::string& method, double ms, double flip, BenchConditions conditions = {},
                 const std::string& fill = "nearest-background") {
    BenchPoint made;
    made.method = method;
    made.fill = fill;
    made.conditions = conditions;
    made.warp_ms = Distribution{ms, ms, ms, ms, ms, ms, ms};
    made.pairs = {{"city", "walk", {flip, 0.9, 30.0, 0.05}}};
    return made;
}

BenchData data_of(std::vector<BenchPoint> points) {
    BenchData data;
    data.points = std::move(points);
    return data;
}

BenchConditions at(int side_px, double age_ms, int samples = 1, double density = 1.0) {
    return {{side_px, side_px}, age_ms, samples, density};
}

/// A cheap, a middling and a good method; mesh needs GL.
BenchData made_up_data() {
    return data_of(
        {point("rotation", 1.0, 0.2), point("splat", 2.0, 0.1), point("surface", 4.0, 0.05), point("mesh", 3.0, 0.04)});
}

AutotuneChoice chosen(const BenchData& data, AutotuneRequest request) {
    const auto choice = choose_method(data, request);
    EXPECT_TRUE(choice) << (choice ? "" : choice.error().message());
    return choice ? *choice : AutotuneChoice{};
}

AutotuneRequest with_cap(double flip, BenchConditions conditions = {}) {
    AutotuneRequest request;
    request.error_cap = flip;
    request.conditions = conditions;
    return request;
}
AutotuneRequest with_budget(double ms, BenchConditions conditions = {}) {
    AutotuneRequest request;
    request.budget_ms = ms;
    request.conditions = conditions;
    return request;
}

TEST(Autotune, UnderACapTheCheapestMethodWins) {
    EXPECT_EQ(chosen(made_up_data(), with_cap(0.3)).method, "rotation");
    EXPECT_EQ(chosen(made_up_data(), with_cap(0.1)).method, "splat");
    EXPECT_EQ(chosen(made_up_data(), with_cap(0.06)).method, "mesh");
    AutotuneRequest live = with_cap(0.06);
    live.gl_allowed = false;
    EXPECT_EQ(chosen(made_up_data(), live).method, "surface");
}

TEST(Autotune, WithinABudgetTheMostExactMethodWins) {
    EXPECT_EQ(chosen(made_up_data(), with_budget(1.5)).method, "rotation");
    EXPECT_EQ(chosen(made_up_data(), with_budget(2.0)).method, "splat");
    EXPECT_EQ(chosen(made_up_data(), with_budget(10.0)).method, "mesh");
}

TEST(Autotune, WhatCannotBeMetIsComeNearTo) {
    const AutotuneChoice best = chosen(made_up_data(), with_cap(0.01));
    EXPECT_EQ(best.method, "mesh");
    EXPECT_FALSE(best.met);
    EXPECT_THAT(best.reason, HasSubstr("none of 4 has FLIP at most 0.01"));
    const AutotuneChoice cheapest = chosen(made_up_data(), with_budget(0.5));
    EXPECT_EQ(cheapest.method, "rotation");
    EXPECT_FALSE(cheapest.met);
}

TEST(Autotune, TheReasonSaysWhichAndWhy) {
    const std::string reason = chosen(made_up_data(), with_cap(0.1, at(512, 100))).reason;
    EXPECT_THAT(reason, HasSubstr("splat with fill nearest-background"));
    EXPECT_THAT(reason, HasSubstr("the cheapest of 3 with FLIP at most 0.1"));
    EXPECT_THAT(reason, HasSubstr("0.1000 in 2.00 ms"));
    EXPECT_EQ(reason.find('\n'), std::string::npos);
}

TEST(Autotune, AGivenFillIsKept) {
    BenchData data = made_up_data();
    data.points.push_back(point("splat", 1.5, 0.15, {}, "none"));
    AutotuneRequest request = with_budget(100.0);
    request.fill = "none";
    EXPECT_EQ(chosen(data, request).method, "splat");
    EXPECT_EQ(chosen(data, request).fill, "none");
}

TEST(Autotune, TimesFollowTheNumberOfPixels) {
    const BenchData data = data_of({point("splat", 1.0, 0.1, at(512, 100)), point("splat", 5.0, 0.1, at(1024, 100))});
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(0.2, at(512, 100))).warp_ms, 1.0);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(0.2, at(1024, 100))).warp_ms, 5.0);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(0.2, at(2048, 100))).warp_ms, 20.0) << "four times the largest measured";
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(0.2, at(256, 100))).warp_ms, 0.25) << "a quarter of the smallest measured";
    BenchConditions between = at(512, 100);
    between.size_px = {1280, 512};  // 2.5 of the 4 quarters of a million: half way
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(0.2, between)).warp_ms, 3.0);
}

TEST(Autotune, ErrorsFollowTheFrameAgeAndTheSource) {
    const BenchData data =
        data_of({point("splat", 1.0, 0.1, at(512, 100)), point("splat", 1.0, 0.3, at(512, 200)),
                 point("splat", 1.0, 0.05, at(512, 100, 2)), point("splat", 1.0, 0.04, at(512, 100, 1, 2.0))});
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(1, at(512, 150))).flip, 0.2);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(1, at(512, 20))).flip, 0.1);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(1, at(512, 900))).flip, 0.3);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(1, at(512, 100, 4))).flip, 0.05);
    EXPECT_DOUBLE_EQ(chosen(data, with_cap(1, at(512, 100, 1, 2.0))).flip, 0.04);
}

TEST(Autotune, PointsWithoutTimeOrErrorOrMethodAreLeftOut) {
    BenchData data = made_up_data();
    data.points.push_back(point("a method of a later version", 0.1, 0.01));
    data.points[1].warp_ms.reset();
    data.points[3].pairs.clear();
    EXPECT_EQ(chosen(data, with_cap(0.1)).method, "surface");
    data.points.clear();
    const auto nothing = choose_method(data, with_cap(0.1));
    ASSERT_FALSE(nothing);
    EXPECT_THAT(nothing.error().message(), HasSubstr("run latewarp bench --quick"));
}

TEST(Autotune, NoDataIsOneLineThatNamesTheMend) {
    const auto folder = fresh_folder("autotune_no_data");
    const ProgramRun run = run_latewarp({"replay", "city", "--trace", "still", "--method", "auto", "--error-cap", "0.1",
                                         "--bench-data", (folder / "none.json").string()});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    EXPECT_THAT(run.err, HasSubstr("run latewarp bench --quick"));
}

TEST(Autotune, DataOfAnotherMachineIsRefused) {
    const auto file = fresh_folder("autotune_other_machine") / "bench.json";
    Report report{Subcommand::bench};
    report.set("suite", "warp");
    describe_machine(report, Machine{"an abacus", 1, "chalk", "1"});
    add_points(report, made_up_data().points);
    ASSERT_TRUE(report.write(file));
    const ProgramRun run = run_latewarp(
        {"replay", "city", "--trace", "still", "--method", "auto", "--budget-ms", "5", "--bench-data", file.string()});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    EXPECT_THAT(run.err, HasSubstr("an abacus"));
    EXPECT_THAT(run.err, HasSubstr("run latewarp bench --quick"));
}

TEST(Autotune, TheOptionsComeTogether) {
    for (const std::vector<std::string>& wrong :
         std::vector<std::vector<std::string>>{{"--method", "auto"},
                                               {"--method", "auto", "--error-cap", "0.1", "--budget-ms", "3"},
                                               {"--error-cap", "0.1"},
                                               {"--method", "splat", "--budget-ms", "3"},
                                               {"--method", "auto", "--error-cap", "0"},
                                               {"--method", "auto", "--budget-ms", "soon"}}) {
        std::vector<std::string> arguments = {"replay", "city", "--trace", "still"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const ProgramRun run = run_latewarp(arguments);
        EXPECT_EQ(run.exit_code, 2) << wrong[1];
        EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    }
}

TEST(GlAutotune, ReplaySaysWhatWasChosenAndReportsIt) {
    const auto folder = fresh_folder("autotune_replay");
    Report report{Subcommand::bench};
    report.set("suite", "warp");
    describe_machine(report, this_machine());
    add_points(report, made_up_data().points);
    ASSERT_TRUE(report.write(folder / "bench.json"));
    const ProgramRun run = run_latewarp({"replay", "city", "--trace", "still", "--size", "32x32", "--seconds", "0.05",
                                         "--method", "auto", "--error-cap", "0.1", "--bench-data",
                                         (folder / "bench.json").string(), "--report", (folder / "r.json").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("latewarp: auto: splat"));
    const auto json = nlohmann::json::parse(text_of(folder / "r.json"));
    EXPECT_EQ(json.at("method"), "splat");
    EXPECT_THAT(json.at("settings").at("chosen_because").get<std::string>(), HasSubstr("the cheapest of"));
}

}  // namespace

}  // namespace lw::test
