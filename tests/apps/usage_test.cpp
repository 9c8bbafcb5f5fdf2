/// Wrong usage: exit code 2, one line on standard error, nothing on standard output, before any work is done.

#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace lw::test {

namespace {

using Arguments = std::vector<std::string>;

class UsageError : public testing::TestWithParam<Arguments> {};

TEST_P(UsageError, IsOneLineAndExitCode2) {
    const ProgramRun run = run_latewarp(GetParam());
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    EXPECT_EQ(run.out, "");
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, UsageError,
    testing::Values(
        Arguments{}, Arguments{"paint"}, Arguments{"--frobnicate"}, Arguments{"replay"},
        Arguments{"replay", "city", "--trace", "walk", "--bogus"}, Arguments{"replay", "city", "--trace"},
        Arguments{"replay", "city", "extra", "--trace", "walk"}, Arguments{"replay", "--trace", ""},
        Arguments{"demo", "--size", "0x0"}, Arguments{"demo", "--size", "100000x100000"},
        Arguments{"demo", "--size", "1024"}, Arguments{"demo", "--size", "-4x4"}, Arguments{"demo", "--size", "4.5x4"},
        Arguments{"demo", "--size", "4x4x4"}, Arguments{"demo", "--size", "axb"}, Arguments{"demo", "--size", ""},
        Arguments{"demo", "--fov", "0"}, Arguments{"demo", "--fov", "180"}, Arguments{"demo", "--fov", "nan"},
        Arguments{"demo", "--near", "0"}, Arguments{"demo", "--near", "inf"}, Arguments{"demo", "--app-hz", "0"},
        Arguments{"demo", "--display-hz", "1e9"}, Arguments{"demo", "--display-hz", "90 Hz"},
        Arguments{"demo", "--seconds", "-1"}, Arguments{"demo", "--lead", "-5"}, Arguments{"demo", "--tracker-hz", "0"},
        Arguments{"demo", "--threads", "1.5"}, Arguments{"demo", "--threads", "0"}, Arguments{"demo", "--seed", "-1"},
        Arguments{"demo", "--param", "buildings"}, Arguments{"demo", "--param", "=3"},
        Arguments{"demo", "--param", "buildings=many"}, Arguments{"demo", "--method", "magic"},
        Arguments{"demo", "--fill", "water"}, Arguments{"demo", "--predict", "tarot"},
        Arguments{"demo", "--source-samples", "3"}, Arguments{"demo", "--source-density", "1.2"},
        Arguments{"demo", "--guard-band", "wide"}, Arguments{"demo", "--guard-band", "-1"},
        Arguments{"demo", "--guard-band", "46"}, Arguments{"demo", "--size", "8192x8192", "--guard-band", "30"},
        Arguments{"render", "city", "-o", "x.png", "--guard-band", "auto"},
        Arguments{"demo", "--source-pose", "guessed"}, Arguments{"demo", "--truth-samples", "3"},
        Arguments{"demo", "--baseline", "stale"}, Arguments{"replay", "--trace", "walk", "--baseline", "magic"},
        Arguments{"replay", "--trace", "walk", "--method", "fresh"},
        Arguments{"replay", "--trace", "walk", "--save-frames"},
        Arguments{"replay", "--trace", "walk", "--size", "8192x8192", "--truth-samples", "4"},
        Arguments{"replay", "--trace", "walk", "--eyes", "three"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--stereo", "magic"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--stereo-output", "hologram"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--ipd", "-1"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--eye-fov", "-45,45,-45"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--eye-fov", "45,-45,-45,45"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--eye-turn", "1,2,3,4"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--eye-turn", "60,0,0"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--stereo", "scanline", "--eye-turn", "0,0,2"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--baseline", "scanline", "--eye-turn", "2,0,0"},
        Arguments{"replay", "--trace", "walk", "--baseline", "two-renders"},
        Arguments{"replay", "--trace", "walk", "--eyes", "stereo", "--stereo", "two-renders", "--shells", "auto"},
        Arguments{"measure", "city", "--size", "64x32", "--strips", "40"},
        Arguments{"measure", "--eyes", "stereo", "--stereo", "scanline", "--shells", "2"},
        Arguments{"render", "city", "--pose", "0,0,0,0,0,0,1"}, Arguments{"render", "city", "-o", ""},
        Arguments{"render", "-o", "x.png"}, Arguments{"render", "city", "-o", "x.png", "--pose", "0,0,0,0,0,0,0"},
        Arguments{"render", "city", "-o", "x.png", "--pose", "0,0,0,0,0,1"},
        Arguments{"render", "city", "-o", "x.png", "--pose", "0,0,nan,0,0,0,1"},
        Arguments{"render", "city", "-o", "x.png", "--time", "soon"}, Arguments{"warp", "-o", "x.png"},
        Arguments{"warp", "frame"}, Arguments{"compare", "a.png"}, Arguments{"compare", "a.png", "b.png", "--ppd", "0"},
        Arguments{"generate", "city"}, Arguments{"generate", "atlantis", "-o", "x.glb"}, Arguments{"info"},
        Arguments{"info", "a", "b"}, Arguments{"bench", "--suite", "magic"}, Arguments{"bench", "--data", ""},
        Arguments{"bench", "city"}, Arguments{"bench", "--save-frames"}, Arguments{"bench", "--part", "half"},
        Arguments{"bench", "--merge", "x.json"}));

/// Options of later versions are refused, never silently ignored.
class OptionToCome : public testing::TestWithParam<std::string> {};

TEST_P(OptionToCome, IsAUsageError) {
    const ProgramRun run = run_latewarp({"replay", "city", "--trace", "walk", GetParam(), "1"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    EXPECT_NE(run.err.find(GetParam()), std::string::npos) << run.err;
}

INSTANTIATE_TEST_SUITE_P(CommandLine, OptionToCome,
                         testing::Values("--shells", "--strips", "--inject", "--load", "--billboards"));

TEST(Help, GoesToStandardOutputAndNamesWhatThereIs) {
    for (const char* subcommand :
         {"demo", "measure", "replay", "render", "warp", "compare", "bench", "generate", "info"}) {
        const ProgramRun run = run_latewarp({subcommand, "--help"});
        EXPECT_EQ(run.exit_code, 0) << subcommand;
        EXPECT_EQ(run.err, "") << subcommand;
        for (const char* word : {"rotation", "splat", "nearest-background", "city", "walk", "oracle"}) {
            EXPECT_NE(run.out.find(word), std::string::npos) << subcommand << " --help lacks " << word;
        }
    }
    const ProgramRun run = run_latewarp({"--help"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.out.find("replay"), std::string::npos);
}

TEST(Version, IsOneLine) {
    const ProgramRun run = run_latewarp({"--version"});
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(run.out.rfind("latewarp ", 0), 0u) << run.out;
    EXPECT_EQ(run.out.find('\n'), run.out.size() - 1) << run.out;
}

}  // namespace

}  // namespace lw::test
