/// Bad input: one line on standard error, exit code 1, and nothing half-written.

#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace lw::test {

namespace {

using Arguments = std::vector<std::string>;

void expect_refused(const Arguments& arguments) {
    const ProgramRun run = run_latewarp(arguments);
    EXPECT_EQ(run.exit_code, 1) << testing::PrintToString(arguments) << "\n" << run.err;
    EXPECT_TRUE(is_one_error_line(run.err)) << testing::PrintToString(arguments) << "\n" << run.err;
    EXPECT_EQ(run.out, "") << testing::PrintToString(arguments);
}

TEST(BadInput, FilesThatAreNotThere) {
    const auto folder = fresh_folder("missing");
    const std::string missing = (folder / "missing").string();
    const std::string png = (folder / "out.png").string();
    expect_refused({"info", missing + ".glb"});
    expect_refused({"info", missing});
    expect_refused({"compare", missing + ".png", missing + ".png"});
    expect_refused({"warp", missing, "--pose", "0,0,0,0,0,0,1", "-o", png});
    expect_refused({"render", missing + ".glb", "-o", png});
    expect_refused({"render", "atlantis", "-o", png});
    expect_refused({"replay", "atlantis", "--trace", "walk", "--out", (folder / "out").string()});
    expect_refused({"replay", "city", "--trace", missing + ".csv", "--report", (folder / "r.json").string()});
    EXPECT_TRUE(files_below(folder).empty());
}

TEST(BadInput, FoldersAndEmptyFilesInPlaceOfFiles) {
    const auto folder = fresh_folder("empty");
    for (const char* name : {"empty.glb", "empty.gltf", "empty.png", "empty.csv", "empty"}) {
        write_text_file(folder / name, "");
    }
    std::filesystem::create_directories(folder / "folder.glb");
    std::filesystem::create_directories(folder / "folder");
    const auto before = files_below(folder);
    const std::string png = (folder / "out.png").string();
    const auto path = [&](const char* name) { return (folder / name).string(); };
    for (const char* name : {"empty.glb", "empty.gltf", "empty.csv", "empty.png", "empty", "folder", "folder.glb"}) {
        expect_refused({"info", path(name)});
    }
    expect_refused({"compare", path("empty.png"), path("empty.png")});
    expect_refused({"compare", path("folder"), path("folder")});
    expect_refused({"render", path("empty.glb"), "-o", png});
    expect_refused({"render", path("folder"), "-o", png});
    expect_refused({"warp", path("folder"), "-o", png});
    expect_refused({"warp", path("empty.csv"), "-o", png});
    expect_refused({"replay", "city", "--trace", path("empty.csv"), "--report", path("r.json")});
    expect_refused({"replay", "city", "--trace", path("folder"), "--report", path("r.json")});
    EXPECT_EQ(files_below(folder), before);
}

TEST(BadInput, ABinaryGltfThatClaimsFourGigabytes) {
    const auto folder = fresh_folder("claims");
    std::string glb{"glTF\x02\x00\x00\x00\xff\xff\xff\xff\xf0\xff\xff\xffJSON{}", 22};
    glb.resize(100, ' ');
    write_text_file(folder / "claims.glb", glb);
    expect_refused({"info", (folder / "claims.glb").string()});
}

TEST(BadInput, TracesThatNobodyCanPlay) {
    const auto folder = fresh_folder("traces");
    const std::string header = "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\n";
    write_text_file(folder / "header.csv", header);
    write_text_file(folder / "words.csv", header + "zero,0,0,0,0,0,0,1\n");
    write_text_file(folder / "zero.csv", header + "0,0,0,0,0,0,0,0\n1,0,0,0,0,0,0,0\n");
    write_text_file(folder / "nan.csv", header + "0,nan,0,0,0,0,0,1\n1,nan,0,0,0,0,0,1\n");
    write_text_file(folder / "prose.csv", "It was a dark and stormy night;\nthe rain fell in torrents.\n");
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        expect_refused({"info", entry.path().string()});
        expect_refused({"replay", "city", "--trace", entry.path().string(), "--quiet"});
    }
}

/// What can be mended is mended, and said.
TEST(BadInput, TracesWithSomeBadRowsPlayWithAWarning) {
    const auto folder = fresh_folder("mended-traces");
    const std::string header = "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\n";
    write_text_file(folder / "backwards.csv",
                    header + "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n0.5,9,9,9,0,0,0,1\n2,0,0,0,0,0,0,1\n");
    write_text_file(folder / "cut.csv", header + "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n2,0,0");
    write_text_file(folder / "scaled.csv", header + "0,0,0,0,0,0,0,2\n1,0,0,0,0,0,0,0\n2,0,0,0,0,0,0,0.5\n");
    for (const auto& entry : std::filesystem::directory_iterator{folder}) {
        const ProgramRun run = run_latewarp({"info", entry.path().string()});
        EXPECT_EQ(run.exit_code, 0) << entry.path() << run.err;
        EXPECT_NE(run.out.find("\"warnings\": [\n"), std::string::npos) << entry.path() << run.out;
    }
}

TEST(BadInput, ScenesWithWrongParameters) {
    const auto folder = fresh_folder("parameters");
    const std::string glb = (folder / "city.glb").string();
    expect_refused({"generate", "city", "-o", glb, "--param", "colour=3"});
    expect_refused({"generate", "city", "-o", glb, "--param", "buildings=-1"});
    expect_refused({"generate", "city", "-o", glb, "--param", "buildings=1e300"});
    EXPECT_TRUE(files_below(folder).empty());
}

TEST(BadInput, OutputsThatCannotBeWritten) {
    const auto folder = fresh_folder("unwritable");
    write_text_file(folder / "file", "not a folder");
    const auto before = files_below(folder);
    const std::string below_a_file = (folder / "file" / "out").string();
    const std::string nowhere = (folder / "nowhere" / "out.png").string();
    expect_refused({"replay", "city", "--trace", "walk", "--out", below_a_file});
    expect_refused({"replay", "city", "--trace", "walk", "--out", "/proc/latewarp"});
    expect_refused({"replay", "city", "--trace", "walk", "--report", nowhere});
    expect_refused({"generate", "city", "-o", nowhere});
    expect_refused({"generate", "city", "-o", folder.string()});
    expect_refused({"render", "city", "-o", nowhere});
    expect_refused({"render", "city", "-o", below_a_file});
    EXPECT_EQ(files_below(folder), before);
}

TEST(BadInput, MethodSettingsThatAreWrong) {
    const auto folder = fresh_folder("settings");
    const std::string report = (folder / "r.json").string();
    const Arguments replay = {"replay",  "city",        "--trace",  "walk", "--quiet",
                              "--param", "buildings=1", "--report", report};
    for (const char* method : {"rotation:speed=1", "rotation:", "splat:x", "stale:x=y"}) {
        Arguments arguments = replay;
        arguments.insert(arguments.end(), {"--method", method});
        expect_refused(arguments);
    }
    EXPECT_TRUE(files_below(folder).empty());
}

TEST(BadInput, FileNamesWithLineBreaksStayOneLine) { expect_refused({"info", "two\nlines.glb"}); }

}  // namespace

}  // namespace lw::test
