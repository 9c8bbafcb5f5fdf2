/// replay with two eyes: the built program on a small city.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image_io.h"
#include "tests/apps/program.h"
#include "tests/support/gl_test.h"
#include "tests/support/shared_data.h"

namespace lw::test {

namespace {

using Json = nlohmann::json;
using Arguments = std::vector<std::string>;

class StereoCommands : public GlTest {};

ProgramRun run_stereo(const std::filesystem::path& folder, const Arguments& more) {
    Arguments arguments = {"replay",    "city",          "--param",      "buildings=6,movers=4",
                           "--size",    "96x96",         "--display-hz", "25",
                           "--seconds", "0.08",          "--eyes",       "stereo",
                           "--out",     folder.string(), "--quiet",      "--trace"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_latewarp(arguments);
}

Json report_of(const std::filesystem::path& folder) { return Json::parse(text_of(folder / "report.json")); }

double mean_of(const Json& figures, const char* figure) { return figures.at(figure).at("mean").get<double>(); }

TEST_F(StereoCommands, TwoReplaysGiveTheSameBytesForBothEyes) {
    const Arguments more = {"walk",        "--baseline",    "scanline",        "--baseline",
                            "two-renders", "--save-frames", "--stereo-output", "files"};
    const auto a = fresh_folder("stereo-a");
    const auto b = fresh_folder("stereo-b");
    for (const auto& folder : {a, b}) {
        const ProgramRun run = run_stereo(folder, more);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
    }
    const auto files_a = files_below(a);
    const auto files_b = files_below(b);
    ASSERT_EQ(files_a.size(), files_b.size());
    EXPECT_EQ(files_a.size(), 2u * 4u * 2u + 4u) << "truth and three methods per frame and eye, reports, strip";
    for (std::size_t i = 0; i < files_a.size(); ++i) {
        if (files_a[i].first == "report.json" || files_a[i].first == "report.html") continue;
        EXPECT_EQ(files_a[i].first, files_b[i].first);
        EXPECT_TRUE(files_a[i].second == files_b[i].second) << files_a[i].first;
    }
    Json report_a = report_of(a);
    Json report_b = report_of(b);
    report_a.erase("cost_ms");
    report_b.erase("cost_ms");
    EXPECT_EQ(report_a, report_b);
    EXPECT_TRUE(report_a.at("stereo").at("rivalry_fraction").at("mean").is_number());
    EXPECT_TRUE(report_a.at("stereo").at("vertical_disparity_px").at("mean").is_number());
    EXPECT_EQ(report_a.at("settings").at("stereo"), "one-render");
}

TEST_F(StereoCommands, AStillHeadSeesTwoRendersAsTheyAre) {
    const auto folder = fresh_folder("stereo-still");
    const ProgramRun run = run_stereo(folder, {"still", "--param", "movers=0", "--stereo", "two-renders", "--baseline",
                                               "fresh-same", "--baseline", "one-render", "--baseline", "scanline"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = report_of(folder);
    EXPECT_EQ(mean_of(report.at("error"), "ssim_to_fresh_same"), 1.0);
    EXPECT_EQ(mean_of(report.at("stereo"), "rivalry_fraction"), 0.0);
    const Json& one_render = report.at("baselines").at("one-render").at("stereo");
    const Json& scanline = report.at("baselines").at("scanline").at("stereo");
    // The eye that scan lines make; the other one is drawn.
    EXPECT_GT(mean_of(one_render.at("left").at("error"), "ssim_to_fresh_same"),
              mean_of(scanline.at("left").at("error"), "ssim_to_fresh_same"));
    EXPECT_EQ(mean_of(scanline.at("right").at("error"), "ssim_to_fresh_same"), 1.0);
    EXPECT_LT(mean_of(one_render, "rivalry_fraction"), mean_of(scanline, "rivalry_fraction"));
}

TEST_F(StereoCommands, ShellsShowBothEyesWhatIsPastTheViewsEdge) {
    const auto folder = fresh_folder("stereo-shells");
    const ProgramRun run =
        run_stereo(folder, {"look-around", "--trace-start", "1.2", "--shells", "2", "--baseline", "two-renders"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = report_of(folder);
    const Json& two = report.at("baselines").at("two-renders").at("stereo");
    for (const char* eye : {"left", "right"}) {
        // The head turns by degrees while a frame is shown; a picture of one pose has nothing there.
        EXPECT_GT(mean_of(two.at(eye).at("error"), "hole_fraction"), 0.03) << eye;
        EXPECT_LT(mean_of(report.at("stereo").at(eye).at("error"), "hole_fraction"), 0.005) << eye;
    }
}

TEST_F(StereoCommands, PicturesAreWrittenAsTheyAreAskedFor) {
    const auto folder = fresh_folder("stereo-layout");
    ASSERT_EQ(run_stereo(folder, {"still", "--save-frames", "--stereo-output", "top-bottom"}).exit_code, 0);
    const auto picture = read_png(folder / "frames" / "00006.truth.png");
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->size_px(), glm::ivec2(96, 192));
}

TEST_F(StereoCommands, EyesThatAreTurnedAreServedByOneRender) {
    const auto folder = fresh_folder("stereo-turned");
    const ProgramRun run =
        run_stereo(folder, {"walk", "--eye-turn", "5,-2,3", "--eye-fov", "-50,40,-50,45", "--baseline", "two-renders"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = report_of(folder);
    const double one = mean_of(report.at("error"), "ssim");
    const double two = mean_of(report.at("baselines").at("two-renders").at("error"), "ssim");
    // The eyes' pictures are seen turned by degrees against the centre's: resampling costs a little.
    EXPECT_GT(one, two - 0.1);
    EXPECT_LT(mean_of(report.at("stereo"), "rivalry_fraction"), 0.1);
}

TEST_F(StereoCommands, TheDemoLeavesWhatBothEyesSaw) {
    const auto folder = fresh_folder("stereo-demo");
    const ProgramRun run = run_latewarp({"demo", "city", "--param", "buildings=6", "--size", "96x64", "--eyes",
                                         "stereo", "--stereo-output", "files", "--seconds", "0.3", "--app-hz", "20",
                                         "--out", folder.string(), "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    for (const char* name : {"eyes.left.png", "eyes.right.png"}) {
        const auto picture = read_png(folder / name);
        ASSERT_TRUE(picture) << name;
        EXPECT_EQ(picture->size_px(), glm::ivec2(96, 64));
    }
}

TEST_F(StereoCommands, DataARecordedHeadsetGivesItsFieldsOfView) {
    const std::string trace = (shared_data_dir() / "head_traces/eyenavgs_rutgers/user103_train.csv").string();
    const auto folder = fresh_folder("stereo-recorded");
    const ProgramRun run = run_stereo(folder, {trace});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json report = report_of(folder);
    // 96 rows over tan 54.0 + tan 42.0 degrees.
    EXPECT_NEAR(report.at("pixels_per_degree").get<double>(), 96.0 / (1.3757 + 0.9004) * 3.14159265 / 180.0, 1e-3);
}

}  // namespace

}  // namespace lw::test
