/// JSON, CSV, HTML and picture strips, from made-up results.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/html_report.h"
#include "apps/picture_strip.h"
#include "apps/replay_report.h"
#include "tests/apps/program.h"

namespace lw::test {

namespace {

using testing::HasSubstr;
using testing::Not;

ReplayResult made_up_result() {
    ReplayResult result;
    result.labels = {"splat", "points:size_px=2,x=1"};
    for (std::uint64_t i = 0; i < 3; ++i) {
        RefreshRecord record;
        record.refresh = 3 + i;
        record.photon_s = 0.14 + 0.04 * static_cast<double>(i);
        record.eyes.emplace_back().errors = {{0.1 * static_cast<double>(i),
                                              0.9,
                                              i == 0 ? std::nullopt : std::optional<double>{30.0},
                                              0.25,
                                              {0.01, 0.02, 0.03, 0.04},
                                              i == 0 ? std::nullopt : std::optional<double>{0.125}},
                                             {0.5, 0.5, 20.0, 0.0, {0.5, 0.0, 0.0, 0.0}, std::nullopt}};
        result.refreshes.push_back(record);
    }
    result.costs.app_ms = {{100.0, 50.0}, {100.0, 50.0}};
    result.costs.warp_ms = {{9.0, 2.0, 2.0}, {8.0, 4.0, 4.0}};
    result.costs.warp_cpu_ms = {{9.0, 1.0, 2.0}, {8.0, 3.0, 4.0}};
    result.costs.prepare_ms = {{}, {}};
    return result;
}

TEST(ReplayReport, HoldsTheKeysThatScriptsRead) {
    Report report{Subcommand::replay};
    add_replay_results(report, made_up_result());
    const auto json = nlohmann::json::parse(report.text());
    EXPECT_EQ(json.at("schema"), "latewarp.replay/1");
    EXPECT_EQ(json.at("frames"), 3);
    for (const char* figure : {"flip", "ssim", "psnr_db", "hole_fraction"}) {
        for (const char* part : {"mean", "min", "p5", "p50", "p95", "p99", "max"}) {
            EXPECT_TRUE(json.at("error").at(figure).at(part).is_number()) << figure << " " << part;
            EXPECT_TRUE(json.at("baselines").at("points:size_px=2,x=1").at("error").at(figure).at(part).is_number());
        }
    }
    EXPECT_EQ(json.at("error").at("psnr_db").at("mean"), 30.0) << "equal images are left out of the mean";
    EXPECT_EQ(json.at("equal_frames"), 1);
    EXPECT_EQ(json.at("error").at("attribution").at("disoccluded").at("p50"), 0.02);
    EXPECT_EQ(json.at("error").at("attribution").at("stale_shading").at("mean"), 0.04);
    EXPECT_EQ(json.at("error").at("flicker").at("mean"), 0.125) << "the first frame has none before it";
    EXPECT_TRUE(json.at("baselines").at("points:size_px=2,x=1").at("error").at("flicker").is_null());
    EXPECT_TRUE(json.at("cause_shares").at("out_of_frame").at("mean").is_number());
    EXPECT_EQ(json.at("cost_ms").at("warp").at("mean"), 2.0) << "the first is the warm-up";
    EXPECT_EQ(json.at("cost_ms").at("warp_cpu").at("mean"), 1.5);
    EXPECT_TRUE(json.at("cost_ms").at("prepare").is_null());
}

ReplayResult made_up_stereo_result() {
    ReplayResult result = made_up_result();
    for (RefreshRecord& record : result.refreshes) {
        EyeRecord right = record.eyes.front();
        right.errors[0].flip += 0.2;
        record.eyes.push_back(right);
        record.consistency = {EyeConsistency{0.01, 0.002, 0.03}, std::nullopt};
    }
    return result;
}

TEST(ReplayReport, PoolsBothEyesAndReportsEach) {
    Report report{Subcommand::replay};
    add_replay_results(report, made_up_stereo_result());
    const auto json = nlohmann::json::parse(report.text());
    EXPECT_EQ(json.at("frames"), 3);
    EXPECT_NEAR(json.at("error").at("flip").at("mean").get<double>(), 0.2, 1e-12);
    EXPECT_EQ(json.at("error").at("flip").at("max"), 0.4);
    EXPECT_EQ(json.at("stereo").at("left").at("error").at("flip").at("max"), 0.2);
    EXPECT_EQ(json.at("stereo").at("right").at("error").at("flip").at("min"), 0.2);
    EXPECT_EQ(json.at("stereo").at("rivalry_fraction").at("mean"), 0.002);
    EXPECT_EQ(json.at("stereo").at("vertical_disparity_px").at("p95"), 0.03);
    EXPECT_EQ(json.at("stereo").at("colour_excess").at("p50"), 0.01);
    const auto& baseline = json.at("baselines").at("points:size_px=2,x=1").at("stereo");
    EXPECT_TRUE(baseline.at("rivalry_fraction").is_null());
    EXPECT_EQ(baseline.at("left").at("error").at("ssim").at("mean"), 0.5);
}

TEST(ReplayReport, CsvHasOneRowPerDisplayFrameAndEye) {
    const std::string csv = replay_csv(made_up_stereo_result());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
    EXPECT_THAT(csv, HasSubstr(",frame_age_ms,eye,cause_shares"));
    EXPECT_THAT(csv, HasSubstr(",splat.rivalry_fraction,splat.vertical_disparity_px,splat.colour_excess,"));
    EXPECT_THAT(csv, HasSubstr(",0.002,0.03,0.01,"));
    EXPECT_THAT(csv, HasSubstr(",right,"));
    const std::string html = replay_html(made_up_stereo_result(), "a", "b", {});
    EXPECT_THAT(html, HasSubstr("How well both eyes agree"));
}

TEST(ReplayReport, CsvHasOneRowPerDisplayFrame) {
    const std::string csv = replay_csv(made_up_result());
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
    EXPECT_THAT(csv, HasSubstr("splat.flip,splat.ssim,splat.psnr_db,splat.hole_fraction,splat.attribution.resampled,"));
    EXPECT_THAT(csv, HasSubstr(",splat.flicker,\"points:size_px=2,x=1.flip\","));
    EXPECT_THAT(csv, HasSubstr(",0,0.9,,0.25,0.01,0.02,0.03,0.04,,0.5,")) << "an equal image has an empty PSNR";
}

TEST(ReplayReport, TheTypicalFrameHasTheMedianFlip) { EXPECT_EQ(typical_refresh(made_up_result()), 1u); }

TEST(ReplayReport, HtmlStandsAloneAndDrawsEveryMethod) {
    const std::string html = replay_html(made_up_result(), "a <title>", "words", {});
    EXPECT_THAT(html, HasSubstr("a &lt;title&gt;"));
    EXPECT_THAT(html, Not(HasSubstr("http")));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
    EXPECT_THAT(html, HasSubstr("<path d=\"M"));
}

TEST(Report, NumbersThatAreNoNumbersAreNull) {
    Report report;
    report.set("a/b", std::numeric_limits<double>::quiet_NaN());
    report.set("a/c", std::optional<double>{});
    report.set("a/text", "\xff");
    const auto json = nlohmann::json::parse(report.text());
    EXPECT_TRUE(json.at("a").at("b").is_null());
    EXPECT_TRUE(json.at("a").at("c").is_null());
}

TEST(Report, IsNotWrittenIntoAMissingFolder) {
    const auto folder = fresh_folder("report");
    EXPECT_FALSE(Report{}.write(folder / "missing" / "report.json"));
    EXPECT_TRUE(files_below(folder).empty());
}

TEST(HtmlReport, Base64OfEveryRemainder) {
    // RFC 4648, section 10.
    const std::vector<std::pair<std::string, std::string>> known = {
        {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}};
    for (const auto& [plain, encoded] : known) {
        HtmlReport page{"t"};
        page.add_png({reinterpret_cast<const std::uint8_t*>(plain.data()), plain.size()}, "c");
        EXPECT_THAT(page.text(), HasSubstr("base64," + encoded + "\""));
    }
}

TEST(PictureStrip, KeepsThePicturesAndWritesBelowThem) {
    ColourImage red{{300, 200}, {200, 0, 0, 255}};
    ColourImage blue{{300, 200}, {0, 0, 200, 255}};
    const ColourImage strip =
        picture_strip({{&red, {"stale", "FLIP 0.123"}}, {&blue, {"a line much wider than 300 pixels"}}});
    const int scale = 2;  // 24 letters of 6 glyph pixels: 288 of 300 pixels
    EXPECT_EQ(strip.width(), 2 * 300 + 3 * 4 * scale);
    EXPECT_EQ(strip.height(), 200 + 2 * 4 * scale + 2 * 10 * scale);
    EXPECT_EQ(strip.at(8, 8), red.at(0, 0));
    EXPECT_EQ(strip.at(8 + 300 + 8 + 299, 8 + 199), blue.at(0, 0));
    const Rgba8 paper{255, 255, 255, 255};
    int ink_px = 0;
    for (int y = 216; y < strip.height(); ++y) {
        for (const Rgba8& pixel : strip.row(y)) ink_px += pixel == paper ? 0 : 1;
        EXPECT_EQ(strip.at(strip.width() - 1, y), paper) << "letters stay below their picture";
    }
    EXPECT_GT(ink_px, 0);
}

}  // namespace

}  // namespace lw::test
