/// compare, generate and info on good input.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/image_io.h"
#include "frame_link/frame_folder.h"
#include "tests/apps/program.h"

namespace lw::test {

namespace {

using Json = nlohmann::json;

ColourImage gradient(glm::ivec2 size_px, int offset) {
    ColourImage image{size_px};
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            image.at(x, y) = {static_cast<std::uint8_t>(x + offset), static_cast<std::uint8_t>(y), 90, 255};
        }
    }
    return image;
}

TEST(Compare, EqualImagesHaveNoPsnr) {
    const auto folder = fresh_folder("compare-equal");
    const std::string png = (folder / "a.png").string();
    ASSERT_TRUE(write_png(png, gradient({40, 30}, 0)));
    const ProgramRun run = run_latewarp({"compare", png, png});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    EXPECT_EQ(Json::parse(run.out), (Json{{"psnr_db", nullptr}, {"ssim", 1.0}, {"flip", 0.0}}));
}

TEST(Compare, AKnownDifference) {
    const auto folder = fresh_folder("compare-known");
    const std::string a = (folder / "a.png").string();
    const std::string b = (folder / "b.png").string();
    ASSERT_TRUE(write_png(a, gradient({40, 30}, 0)));
    ASSERT_TRUE(write_png(b, gradient({40, 30}, 3)));
    const ProgramRun run = run_latewarp({"compare", a, b, "--ppd", "20"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out);
    // Red is off by 3 everywhere: a mean square of 9 / 3 over the channels.
    EXPECT_NEAR(json.at("psnr_db").get<double>(), 10.0 * std::log10(255.0 * 255.0 / 3.0), 1e-9);
    EXPECT_LT(json.at("ssim").get<double>(), 1.0);
    EXPECT_GT(json.at("flip").get<double>(), 0.0);
}

TEST(Compare, SizesMustMatch) {
    const auto folder = fresh_folder("compare-sizes");
    const std::string a = (folder / "a.png").string();
    const std::string b = (folder / "b.png").string();
    ASSERT_TRUE(write_png(a, gradient({40, 30}, 0)));
    ASSERT_TRUE(write_png(b, gradient({30, 40}, 0)));
    const ProgramRun run = run_latewarp({"compare", a, b});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
    EXPECT_EQ(run.out, "");
}

TEST(Generate, TwiceGivesTheSameBytes) {
    const auto folder = fresh_folder("generate");
    for (const char* name : {"a.glb", "b.glb"}) {
        const ProgramRun run = run_latewarp(
            {"generate", "city", "-o", (folder / name).string(), "--param", "buildings=6,movers=3", "--seed", "5"});
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    const auto files = files_below(folder);
    ASSERT_EQ(files.size(), 2u) << "no temporary file stays";
    EXPECT_TRUE(files[0].second == files[1].second);
    const ProgramRun run = run_latewarp(
        {"generate", "city", "-o", (folder / "c.glb").string(), "--param", "buildings=6,movers=3", "--seed", "6"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_FALSE(text_of(folder / "c.glb") == files[0].second) << "the seed changes the city";
}

TEST(Info, OfASceneOnDiskIsThatOfTheSceneInCode) {
    const auto folder = fresh_folder("info-scene");
    const std::string glb = (folder / "city.glb").string();
    ASSERT_EQ(run_latewarp({"generate", "city", "-o", glb, "--param", "buildings=6,movers=3"}).exit_code, 0);
    const ProgramRun run = run_latewarp({"info", glb});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out);
    EXPECT_EQ(json.at("schema"), "latewarp.info/1");
    EXPECT_EQ(json.at("kind"), "scene");
    EXPECT_GT(json.at("scene").at("triangles").get<int>(), 0);
    EXPECT_EQ(json.at("scene").at("movers"), 3);
    EXPECT_TRUE(json.at("scene").at("bounds_world").contains("min_m"));
    EXPECT_TRUE(json.at("warnings").is_array());
}

TEST(Info, OfATrace) {
    const auto folder = fresh_folder("info-trace");
    write_text_file(folder / "trace.csv",
                    "time_s,px_m,py_m,pz_m,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.5,1,0,0,0,0,0,1\n2,1,2,0,0,0,0,1\n");
    for (const std::string& name : {(folder / "trace.csv").string(), std::string{"walk"}}) {
        const ProgramRun run = run_latewarp({"info", name});
        ASSERT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(Json::parse(run.out).at("kind"), "trace");
    }
    const Json json = Json::parse(run_latewarp({"info", (folder / "trace.csv").string()}).out).at("trace");
    EXPECT_EQ(json.at("samples"), 3);
    EXPECT_EQ(json.at("duration_s"), 2.0);
    EXPECT_EQ(json.at("longest_gap_s"), 1.5);
    EXPECT_EQ(json.at("path_m"), 3.0);
    EXPECT_EQ(json.at("bounds").at("max_m"), (Json{1.0, 2.0, 0.0}));
}

/// A frame folder made without a renderer, as someone else's program would.
RenderedFrame small_frame() {
    auto layer = std::make_shared<Layer>();
    layer->camera.size_px = {32, 24};
    layer->camera.fov = FovTangents::symmetric(1.0, 32.0 / 24.0);
    layer->camera.world_from_eye.position_m = {1.0, 2.0, 3.0};
    layer->scene_time_s = 0.25;
    layer->movers = {{1, glm::dmat4{1.0}}};
    CpuPixels& pixels = layer->cpu();
    pixels.colour = gradient({32, 24}, 7);
    pixels.depth = DepthImage{{32, 24}, 0.01f};
    pixels.object_id = ObjectIdImage{{32, 24}, 0};
    pixels.depth.at(0, 0) = 0.0f;
    pixels.object_id.at(5, 5) = 1;
    return {1, {std::move(layer)}, {}};
}

TEST(Info, OfAFrameFolder) {
    const auto folder = fresh_folder("info-frame");
    ASSERT_TRUE(save_frame_folder(small_frame(), folder / "frame"));
    const ProgramRun run = run_latewarp({"info", (folder / "frame").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const Json json = Json::parse(run.out);
    EXPECT_EQ(json.at("kind"), "frame");
    const Json& layer = json.at("layers").at("main");
    EXPECT_EQ(layer.at("size_px"), (Json{32, 24}));
    EXPECT_EQ(layer.at("objects"), 1);
    EXPECT_NEAR(layer.at("nearest_m").get<double>(), 5.0, 1e-5) << "0.05 m / 0.01 as a float";
    EXPECT_NEAR(layer.at("background_fraction").get<double>(), 1.0 / (32 * 24), 1e-12);
}

TEST(Warp, ToItsOwnPoseReturnsTheColourBitForBit) {
    const auto folder = fresh_folder("warp-identity");
    ASSERT_TRUE(save_frame_folder(small_frame(), folder / "frame"));
    const std::string png = (folder / "out.png").string();
    for (const char* method : {"stale", "rotation", "splat", "reference"}) {
        for (const bool explicit_pose : {false, true}) {
            std::vector<std::string> arguments = {"warp", (folder / "frame").string(), "-o", png, "--method", method};
            if (explicit_pose) arguments.insert(arguments.end(), {"--pose", "1,2,3,0,0,0,1"});
            const ProgramRun run = run_latewarp(arguments);
            ASSERT_EQ(run.exit_code, 0) << run.err;
            const auto shown = read_png(png);
            ASSERT_TRUE(shown);
            EXPECT_TRUE(*shown == small_frame().layers.front()->cpu().colour) << method;
        }
    }
}

TEST(Warp, TakesSizeAndObjectsFromTheCommandLine) {
    const auto folder = fresh_folder("warp-objects");
    ASSERT_TRUE(save_frame_folder(small_frame(), folder / "frame"));
    // The mover goes 1 km away to the left: its pixel leaves the picture.
    write_text_file(folder / "objects.json",
                    R"({"objects": [{"id": 1, "world_from_object": [1,0,0,0, 0,1,0,0, 0,0,1,0, -1000,0,0,1]}]})");
    const std::string png = (folder / "out.png").string();
    const ProgramRun run = run_latewarp({"warp", (folder / "frame").string(), "-o", png, "--method", "reference",
                                         "--fill", "none", "--objects", (folder / "objects.json").string()});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto moved = read_png(png);
    ASSERT_TRUE(moved);
    EXPECT_FALSE(moved->at(5, 5) == small_frame().layers.front()->cpu().colour.at(5, 5));
    EXPECT_EQ(moved->at(9, 5), small_frame().layers.front()->cpu().colour.at(9, 5));
    ASSERT_EQ(run_latewarp({"warp", (folder / "frame").string(), "-o", png, "--size", "64x20"}).exit_code, 0);
    EXPECT_EQ(read_png(png)->size_px(), glm::ivec2(64, 20));
}

TEST(Warp, RefusesBadFrameFoldersAndObjects) {
    const auto folder = fresh_folder("warp-bad");
    ASSERT_TRUE(save_frame_folder(small_frame(), folder / "frame"));
    write_text_file(folder / "objects.json", "{\"objects\": [{\"id\": 1, \"world_from_object\": [1, 2]}]}");
    const std::string png = (folder / "out.png").string();
    const auto expect_refused = [&](const std::vector<std::string>& arguments) {
        const ProgramRun run = run_latewarp(arguments);
        EXPECT_EQ(run.exit_code, 1) << run.err;
        EXPECT_TRUE(is_one_error_line(run.err)) << run.err;
        EXPECT_FALSE(std::filesystem::exists(png));
    };
    const std::string frame = (folder / "frame").string();
    expect_refused({"warp", frame, "-o", png, "--objects", (folder / "objects.json").string()});
    expect_refused({"warp", frame, "-o", png, "--objects", (folder / "missing.json").string()});
    std::filesystem::remove(folder / "frame" / "main.depth.pfm");
    expect_refused({"warp", frame, "-o", png});
    write_text_file(folder / "frame" / "frame.json", "{");
    expect_refused({"warp", frame, "-o", png});
    std::filesystem::remove(folder / "frame" / "frame.json");
    expect_refused({"warp", frame, "-o", png});
}

}  // namespace

}  // namespace lw::test
