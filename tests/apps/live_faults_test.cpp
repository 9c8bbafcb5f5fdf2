/// A live run that is disturbed from outside ends cleanly and leaves its report.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/gl_test.h"

namespace lw {
namespace {

using nlohmann::json;

int run_shell(const std::string& command) {
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string measure_command(const std::string& seconds, const std::filesystem::path& folder, const std::string& more) {
    return std::string{LW_PROGRAM} + " measure chairs --size 128x128 --quiet --seconds " + seconds + " --out " +
           folder.string() + " " + more;
}

class GlLiveFaults : public test::GlTest {};

// Ctrl-C when the server's thread is there, long before the run's end.
TEST_F(GlLiveFaults, CtrlCEndsTheRunWithItsReport) {
    const auto folder = test::fresh_folder("interrupted");
    const auto out = folder / "out";
    const std::string command = measure_command("600", out, "2> " + (folder / "err").string()) +
                                " & pid=$!; until grep -qs lw-server /proc/$pid/task/*/comm; do sleep 0.1; done; "
                                "kill -INT $pid; wait $pid";
    EXPECT_EQ(run_shell(command), 0) << test::text_of(folder / "err");
    const json report = json::parse(test::text_of(out / "report.json"));
    EXPECT_TRUE(report.at("interrupted").get<bool>());
    EXPECT_EQ(test::text_of(folder / "err"), "");
}

// A disk that takes no more than 4 KiB per file: the run ends with one line that says so, and leaves no half a file.
TEST_F(GlLiveFaults, AFullDiskIsOneErrorLine) {
    const auto folder = test::fresh_folder("full");
    const std::string command =
        "trap '' XFSZ; ulimit -f 8; " + measure_command("1.5", folder / "out", "2> " + (folder / "err").string());
    EXPECT_EQ(run_shell("bash -c \"" + command + "\""), 1);
    EXPECT_TRUE(test::is_one_error_line(test::text_of(folder / "err"))) << test::text_of(folder / "err");
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "refreshes.csv"));
}

TEST_F(GlLiveFaults, AStalledClientIsReportedAsWhatItIs) {
    const auto folder = test::fresh_folder("stalled");
    EXPECT_EQ(run_shell(measure_command("5", folder / "out", "--load stall=800")), 0);
    const json report = json::parse(test::text_of(folder / "out" / "report.json"));
    EXPECT_LT(report.at("app").at("hz").get<double>(), 1.3);
    EXPECT_GT(report.at("display").at("refreshes").get<int>(), 200);
    EXPECT_GT(report.at("latency_ms").at("frame_age").at("max").get<double>(), 700.0);
    EXPECT_EQ(report.at("settings").at("load").at("stall_ms").get<double>(), 800.0);
}

}  // namespace
}  // namespace lw
