/// What the command line means, option by option.

#include <gtest/gtest.h>

#include "apps/options.h"

namespace lw::test {

namespace {

Options parsed(const std::vector<std::string>& arguments) {
    const Result<CommandLine> line = parse_command_line(arguments);
    EXPECT_TRUE(line.ok()) << (line.ok() ? "" : line.error().message());
    return line.ok() ? line->options : Options{};
}

TEST(Options, DefaultsAreThoseOfTheManual) {
    const Options options = parsed({"demo"});
    EXPECT_EQ(options.subcommand, Subcommand::demo);
    EXPECT_EQ(options.scene, "city");
    EXPECT_EQ(options.size_px, glm::ivec2(1024, 1024));
    EXPECT_EQ(options.fov_deg, 90.0);
    EXPECT_EQ(options.near_m, 0.05);
    EXPECT_EQ(options.fill, "nearest-background");
    EXPECT_EQ(parsed({"replay", "--trace", "walk"}).fill, "pyramid");
    EXPECT_EQ(options.display_hz, 90.0);
    EXPECT_EQ(options.tracker_hz, 1000.0);
    EXPECT_EQ(options.lead_ms, 5.0);
    EXPECT_EQ(options.truth_samples, 2);
    EXPECT_EQ(options.seconds, 10.0);
    EXPECT_EQ(options.source_pose, SourcePose::predicted);
    EXPECT_EQ(options.source.samples_per_axis, 1);
    EXPECT_EQ(options.source.density, 1.0);
    EXPECT_FALSE(options.source.guard_band_rad) << "auto";
    EXPECT_FALSE(options.app_hz);
    EXPECT_FALSE(options.predict);
    EXPECT_FALSE(options.pose);
}

TEST(Options, ReplayTakesEverything) {
    const Options options =
        parsed({"replay",        "--size",      "640x480",       "--trace",  "walk",       "house.glb",
                "--trace-start", "2.5",         "--method",      "rotation", "--baseline", "stale",
                "--baseline",    "fresh",       "--baseline",    "stale",    "--app-hz",   "5",
                "--app-latency", "80",          "--fov",         "60",       "--param",    "buildings=4,movers=2",
                "--param",       "buildings=5", "--source-pose", "sampled",  "--out",      "o",
                "--save-frames", "--quiet",     "--threads",     "2",        "--predict",  "none"});
    EXPECT_EQ(options.scene, "house.glb");
    EXPECT_EQ(options.size_px, glm::ivec2(640, 480));
    EXPECT_EQ(options.trace, "walk");
    EXPECT_EQ(options.trace_start_s, 2.5);
    EXPECT_EQ(options.method, "rotation");
    EXPECT_EQ(options.baselines, (std::vector<std::string>{"stale", "fresh"})) << "repeats are dropped";
    EXPECT_EQ(options.app_hz, 5.0);
    EXPECT_EQ(options.app_latency_ms, 80.0);
    EXPECT_EQ(options.parameters, (scene::Parameters{{"buildings", 5.0}, {"movers", 2.0}}));
    EXPECT_EQ(options.source_pose, SourcePose::sampled);
    EXPECT_EQ(options.predict, "none");
    EXPECT_TRUE(options.save_frames);
    EXPECT_TRUE(options.quiet);
    EXPECT_EQ(options.threads, 2);
}

TEST(Options, TheSourceIsDescribed) {
    const Options options =
        parsed({"replay", "--trace", "walk", "--source-samples", "4", "--source-density", "1.5", "--guard-band", "5"});
    EXPECT_EQ(options.source.samples_per_axis, 4);
    EXPECT_EQ(options.source.density, 1.5);
    ASSERT_TRUE(options.source.guard_band_rad);
    EXPECT_NEAR(*options.source.guard_band_rad, 5.0 * kRadPerDeg, 1e-12);
    EXPECT_FALSE(parsed({"demo", "--guard-band", "5", "--guard-band", "auto"}).source.guard_band_rad);
    EXPECT_EQ(parsed({"render", "city", "-o", "x.png"}).source.guard_band_rad, 0.0) << "one frame tells no motion";
}

TEST(Options, TheLastOfARepeatedOptionHolds) {
    EXPECT_EQ(parsed({"demo", "--fov", "60", "--fov", "70"}).fov_deg, 70.0);
}

TEST(Options, PosesMayBeginWithAMinus) {
    const Options options = parsed({"render", "city", "-o", "x.png", "--pose", "-1,2,-3,0,0,0,2"});
    ASSERT_TRUE(options.pose);
    EXPECT_EQ(options.pose->position_m, glm::dvec3(-1, 2, -3));
    EXPECT_EQ(options.pose->orientation, glm::dquat(1, 0, 0, 0)) << "quaternions are normalised";
}

TEST(Options, TheCameraHasTheVerticalFieldOfView) {
    const Camera camera = parsed({"demo", "--size", "200x100", "--fov", "90"}).camera();
    // tan(45 degrees) is 1 to within one rounding step of the double.
    EXPECT_NEAR(camera.fov.up, 1.0, 1e-15);
    EXPECT_NEAR(camera.fov.right, 2.0, 1e-15);
}

TEST(Options, SeedIsASceneParameterWhereTheSceneHasOne) {
    EXPECT_EQ(parsed({"demo", "city", "--seed", "7"}).parameters.count("seed"), 1u);
    EXPECT_EQ(parsed({"demo", "city", "--seed", "7", "--param", "seed=8"}).parameters.at("seed"), 8.0);
    EXPECT_TRUE(parsed({"demo", "house.glb", "--seed", "7"}).parameters.empty());
}

}  // namespace

}  // namespace lw::test
