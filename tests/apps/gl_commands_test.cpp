/// render and replay, which draw: the built program on a small city.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image_io.h"
#include "tests/apps/program.h"
#include "tests/support/gl_test.h"

namespace lw::test {

namespace {

using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

const Arguments kSmallCity = {"city", "--param", "buildings=6,movers=4", "--size", "96x96", "--quiet"};

Arguments with_small_city(const std::string& subcommand, const Arguments& more) {
    Arguments arguments = {subcommand};
    arguments.insert(arguments.end(), kSmallCity.begin(), kSmallCity.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

class GlCommands : public GlTest {};

TEST_F(GlCommands, WarpingARenderedFrameToItsOwnPoseReturnsItsColour) {
    const auto folder = fresh_folder("render-warp");
    const std::string frame = (folder / "frame").string();
    const std::string truth = (folder / "truth.png").string();
    const ProgramRun render = run_latewarp(with_small_city("render", {"-o", truth, "--frame", frame, "--time", "0.5"}));
    ASSERT_EQ(render.exit_code, 0) << render.err;
    EXPECT_EQ(render.err, "");
    const auto source = read_png(folder / "frame" / "main.color.png");
    ASSERT_TRUE(source);
    EXPECT_EQ(source->size_px(), glm::ivec2(96, 96));
    for (const char* method : {"stale", "rotation", "points:size_px=1", "splat", "reference"}) {
        const std::string png = (folder / "warped.png").string();
        const ProgramRun warp = run_latewarp({"warp", frame, "-o", png, "--method", method});
        ASSERT_EQ(warp.exit_code, 0) << warp.err;
        EXPECT_TRUE(*read_png(png) == *source) << method;
    }
    const ProgramRun compare = run_latewarp({"compare", truth, (folder / "frame" / "main.color.png").string()});
    // One sample per pixel against four: aliased, but the same picture.
    EXPECT_GT(Json::parse(compare.out).at("psnr_db").get<double>(), 18.0) << compare.out;
}

Json report_of(const std::filesystem::path& folder) { return Json::parse(text_of(folder / "report.json")); }

ProgramRun run_replay(const std::filesystem::path& folder, const Arguments& more = {}) {
    Arguments arguments = with_small_city(
        "replay", {"--trace", "walk", "--display-hz", "25", "--seconds", "0.4", "--out", folder.string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_latewarp(arguments);
}

TEST_F(GlCommands, TwoReplaysGiveTheSameBytes) {
    const Arguments more = {"--baseline", "stale",      "--baseline", "rotation",     "--baseline",
                            "points",     "--baseline", "fresh",      "--save-frames"};
    for (const char* name : {"replay-a", "replay-b"}) {
        const ProgramRun run = run_replay(fresh_folder(name), more);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
    }
    const std::filesystem::path parent = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "apps";
    const auto a = files_below(parent / "replay-a");
    const auto b = files_below(parent / "replay-b");
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(a.size(), 10u * 6u + 4u) << "truth and five methods per frame, JSON, CSV, HTML, strip";
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_EQ(a[i].first, b[i].first);
        // Both hold wall times.
        if (a[i].first == "report.json" || a[i].first == "report.html") continue;
        EXPECT_TRUE(a[i].second == b[i].second) << a[i].first;
    }
    Json report_a = report_of(parent / "replay-a");
    Json report_b = report_of(parent / "replay-b");
    EXPECT_TRUE(report_a.at("cost_ms").at("warp").at("p50").is_number());
    report_a.erase("cost_ms");
    report_b.erase("cost_ms");
    EXPECT_EQ(report_a, report_b);
    EXPECT_EQ(report_a.at("frames"), 10);
    EXPECT_EQ(report_a.at("scene").at("movers"), 4);
    EXPECT_TRUE(report_a.at("machine").at("gl_renderer").is_string());
    EXPECT_EQ(report_a.at("baselines").size(), 4u);
}

TEST_F(GlCommands, AStillHeadInAStillSceneShowsTheSourceWithEveryMethod) {
    const auto folder = fresh_folder("replay-still");
    const ProgramRun run = run_replay(folder, {"--trace", "still", "--param", "movers=0", "--baseline", "stale",
                                               "--baseline", "rotation", "--baseline", "fresh-same"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = report_of(folder);
    for (const char* method : {"stale", "rotation", "fresh-same"}) {
        // Equal pictures have equal errors against the truth, to the last bit.
        EXPECT_EQ(report.at("baselines").at(method).at("error"), report.at("error")) << method;
    }
    EXPECT_EQ(report.at("error").at("hole_fraction").at("max"), 0.0);
}

TEST_F(GlCommands, TheFrameAgeFollowsTheAppLatency) {
    const auto folder = fresh_folder("replay-age");
    ASSERT_EQ(run_replay(folder, {"--app-latency", "20", "--app-hz", "25", "--method", "stale"}).exit_code, 0);
    const Json age_ms = report_of(folder).at("frame_age_ms");
    // Published 20 ms after the pose; one latch per client frame falls between 0 and 40 ms later, the photons follow
    // 5 + 20 ms after that.
    EXPECT_GE(age_ms.at("min").get<double>(), 45.0);
    EXPECT_LT(age_ms.at("max").get<double>(), 86.0);
}

TEST_F(GlCommands, APredictorSeesLessThanTheOracle) {
    const auto oracle = fresh_folder("replay-oracle");
    const auto none = fresh_folder("replay-none");
    ASSERT_EQ(run_replay(oracle, {"--method", "reference", "--trace", "shake"}).exit_code, 0);
    ASSERT_EQ(run_replay(none, {"--method", "reference", "--trace", "shake", "--predict", "none"}).exit_code, 0);
    EXPECT_LT(report_of(oracle).at("error").at("flip").at("mean").get<double>(),
              report_of(none).at("error").at("flip").at("mean").get<double>());
}

TEST_F(GlCommands, AGuardBandClosesTheEdgesOfATurn) {
    const auto none = fresh_folder("replay-no-band");
    const auto given = fresh_folder("replay-band");
    const auto automatic = fresh_folder("replay-auto-band");
    const Arguments turn = {"--trace", "look-around", "--trace-start", "1", "--method", "rotation"};
    const auto with = [&turn](const char* band) {
        Arguments arguments = turn;
        arguments.insert(arguments.end(), {"--guard-band", band});
        return arguments;
    };
    ASSERT_EQ(run_replay(none, with("0")).exit_code, 0);
    ASSERT_EQ(run_replay(given, with("8")).exit_code, 0);
    ASSERT_EQ(run_replay(automatic, with("auto")).exit_code, 0);
    const auto holes = [](const Json& report) {
        return report.at("error").at("hole_fraction").at("mean").get<double>();
    };
    const auto ratio = [](const Json& report) { return report.at("settings").at("source_pixels_ratio").get<double>(); };
    EXPECT_EQ(ratio(report_of(none)), 1.0);
    EXPECT_GT(ratio(report_of(given)), 1.5);
    EXPECT_GT(ratio(report_of(automatic)), 1.0);
    EXPECT_LE(ratio(report_of(automatic)), 2.0);
    EXPECT_GT(holes(report_of(none)), 0.0) << "the head turns";
    EXPECT_LT(holes(report_of(given)), 0.5 * holes(report_of(none)));
    EXPECT_LT(holes(report_of(automatic)), 0.5 * holes(report_of(none)));
    EXPECT_EQ(report_of(automatic).at("settings").at("guard_band_deg"), "auto");
}

TEST_F(GlCommands, StaleShowsTheMiddleOfAGuardBand) {
    const auto folder = fresh_folder("replay-stale-band");
    const Arguments more = {"--trace",  "still", "--param",    "movers=0", "--guard-band", "5",
                            "--method", "stale", "--baseline", "rotation", "--baseline",   "splat"};
    ASSERT_EQ(run_replay(folder, more).exit_code, 0);
    const Json report = report_of(folder);
    for (const char* method : {"rotation", "splat"}) {
        // Without motion all copy the same pixels.
        EXPECT_EQ(report.at("baselines").at(method).at("error"), report.at("error")) << method;
    }
    EXPECT_EQ(report.at("error").at("hole_fraction").at("max"), 0.0);
}

TEST_F(GlCommands, FreshSameHasTheSourcesSamples) {
    const auto folder = fresh_folder("replay-samples");
    const Arguments more = {"--source-samples", "2",     "--source-density", "1.5",
                            "--baseline",       "fresh", "--baseline",       "fresh-same"};
    ASSERT_EQ(run_replay(folder, more).exit_code, 0);
    const Json report = report_of(folder);
    const auto flip = [&report](const char* method) {
        return report.at("baselines").at(method).at("error").at("flip").at("mean").get<double>();
    };
    EXPECT_LT(flip("fresh-same"), 0.9 * flip("fresh"));
    EXPECT_EQ(report.at("settings").at("source_samples"), 2);
    EXPECT_EQ(report.at("settings").at("source_density"), 1.5);
}

TEST_F(GlCommands, ARenderedFrameHasTheSourceThatWasAskedFor) {
    const auto folder = fresh_folder("render-source");
    const std::string frame = (folder / "frame").string();
    const std::string truth = (folder / "truth.png").string();
    const ProgramRun render =
        run_latewarp(with_small_city("render", {"-o", truth, "--frame", frame, "--guard-band", "5", "--source-density",
                                                "2", "--source-samples", "2"}));
    ASSERT_EQ(render.exit_code, 0) << render.err;
    EXPECT_EQ(read_png(folder / "truth.png")->size_px(), glm::ivec2(96, 96));
    const auto source = read_png(folder / "frame" / "main.color.png");
    ASSERT_TRUE(source);
    // tan 50 degrees = 1.1918: 9.2 of 48 pixels more per side, so 10.
    EXPECT_EQ(source->size_px(), glm::ivec2(2 * (96 + 20)));
}

TEST_F(GlCommands, ScenesBeyondWhatIsDrawnStillRender) {
    const auto folder = fresh_folder("render-away");
    const std::string png = (folder / "sky.png").string();
    // A kilometre above the city, looking up: nothing but sky.
    const ProgramRun run =
        run_latewarp(with_small_city("render", {"-o", png, "--pose", "0,1000,0,0.70710678,0,0,0.70710678"}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(read_png(png));
}

}  // namespace

}  // namespace lw::test
