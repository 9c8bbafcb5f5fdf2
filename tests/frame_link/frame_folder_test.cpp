#include "frame_link/frame_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/image_io.h"
#include "tests/frame_link/temporary_folder.h"

namespace lw {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr glm::ivec2 kSize_px{7, 5};

std::shared_ptr<Layer> make_layer(const std::string& name) {
    auto layer = std::make_shared<Layer>();
    layer->name = name;
    layer->camera.world_from_eye = {{1.0 / 3.0, 1.7, -2e-7}, glm::angleAxis(0.7, glm::normalize(glm::dvec3{1, 2, 3}))};
    layer->camera.world_from_eye = *sanitised(layer->camera.world_from_eye);
    layer->camera.fov = {-0.9, 1.1, -1.0 / 7.0, 0.8};
    layer->camera.near_m = 0.05;
    layer->camera.size_px = kSize_px;
    layer->pose_sampled = at_seconds(12.345678901);
    layer->scene_time_s = 12.35;
    CpuPixels pixels{ColourImage{kSize_px}, DepthImage{kSize_px}, ObjectIdImage{kSize_px}};
    for (int y = 0; y < kSize_px.y; ++y) {
        for (int x = 0; x < kSize_px.x; ++x) {
            pixels.colour.at(x, y) = {static_cast<std::uint8_t>(x * 30), static_cast<std::uint8_t>(y * 50), 17, 255};
            pixels.depth.at(x, y) = static_cast<float>(x) / 7.0F;
            pixels.object_id.at(x, y) = static_cast<ObjectId>(x == 3 ? 2 : (x == 4 ? 65535 : 0));
        }
    }
    layer->pixels = std::move(pixels);
    glm::dmat4 placed{1.0};
    placed[0][1] = 1e-17;
    placed[3] = {1.0 / 3.0, -4.0, 5e10, 1.0};
    layer->movers = {{2, glm::dmat4{1.0}}, {65535, placed}};
    return layer;
}

RenderedFrame make_frame() {
    RenderedFrame frame;
    frame.index = 42;
    frame.layers = {make_layer("main"), make_layer("shell-1_far")};
    return frame;
}

bool same_bits(const DepthImage& a, const DepthImage& b) {
    return a.size_px() == b.size_px() && std::memcmp(a.pixels().data(), b.pixels().data(), a.size_bytes()) == 0;
}

void replace(std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
}

class FrameFolder : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path frame_path() const { return temporary_.path() / "frame"; }

    void save(const RenderedFrame& frame) const {
        const Status status = save_frame_folder(frame, frame_path());
        ASSERT_TRUE(status.ok()) << status.error().message();
    }
    LoadedFrame loaded() const {
        auto frame = load_frame_folder(frame_path());
        EXPECT_TRUE(frame.ok()) << (frame.ok() ? "" : frame.error().message());
        return frame.ok() ? std::move(*frame) : LoadedFrame{};
    }
    [[nodiscard]] std::string description() const {
        std::stringstream text;
        text << std::ifstream{frame_path() / "frame.json"}.rdbuf();
        return text.str();
    }
    /// Changes the text of a good frame.json and returns what the loader says to it.
    std::string refused(const std::string& from, const std::string& to) {
        save(make_frame());
        std::string text = description();
        replace(text, from, to);
        (void)temporary_.file("frame/frame.json", text);
        const auto frame = load_frame_folder(frame_path());
        EXPECT_FALSE(frame.ok()) << from << " -> " << to;
        if (frame.ok()) return "loaded";
        EXPECT_THAT(frame.error().where, HasSubstr((frame_path() / "").string()));
        EXPECT_EQ(frame.error().message().find('\n'), std::string::npos);
        return frame.error().what;
    }

    test::TemporaryFolder temporary_;
};

TEST_F(FrameFolder, ReadsBackBitForBit) {
    RenderedFrame frame = make_frame();
    const std::shared_ptr<Layer> with_shares = make_layer("edges");
    with_shares->cpu().alpha_is_share = true;
    with_shares->cpu().colour.at(1, 1).a = 64;
    with_shares->cpu().quarters = ColourImage{2 * with_shares->camera.size_px, {1, 2, 3, 255}};
    with_shares->cpu().quarters.at(3, 2) = {200, 100, 50, 255};
    with_shares->cpu().quarter_samples = 4;
    frame.layers.push_back(with_shares);
    save(frame);
    const LoadedFrame again = loaded();
    ASSERT_NE(again.frame, nullptr);
    EXPECT_THAT(again.warnings, IsEmpty());
    EXPECT_EQ(again.frame->index, 42U);
    ASSERT_EQ(again.frame->layers.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const Layer& before = *frame.layers[i];
        const Layer& after = *again.frame->layers[i];
        EXPECT_EQ(after.name, before.name);
        EXPECT_EQ(after.camera, before.camera);
        EXPECT_EQ(after.pose_sampled, before.pose_sampled);
        EXPECT_EQ(after.scene_time_s, before.scene_time_s);
        EXPECT_EQ(after.movers, before.movers);
        EXPECT_EQ(after.cpu().colour, before.cpu().colour);
        EXPECT_EQ(after.cpu().object_id, before.cpu().object_id);
        EXPECT_EQ(after.cpu().alpha_is_share, before.cpu().alpha_is_share);
        EXPECT_EQ(after.cpu().quarters, before.cpu().quarters);
        EXPECT_EQ(after.cpu().quarter_samples, before.cpu().quarter_samples);
        EXPECT_TRUE(same_bits(after.cpu().depth, before.cpu().depth));
    }
}

TEST_F(FrameFolder, HoldsTheFilesItPromisesAndNoOthers) {
    save(make_frame());
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator{frame_path()}) {
        names.push_back(entry.path().filename().string());
    }
    EXPECT_THAT(names,
                testing::UnorderedElementsAre("frame.json", "main.color.png", "main.depth.pfm", "main.id.png",
                                              "shell-1_far.color.png", "shell-1_far.depth.pfm", "shell-1_far.id.png"));
}

TEST_F(FrameFolder, BadPixelsAreCountedAndKept) {
    RenderedFrame frame = make_frame();
    auto layer = make_layer("main");
    layer->cpu().depth.at(0, 0) = std::numeric_limits<float>::quiet_NaN();
    layer->cpu().depth.at(1, 0) = -0.5F;
    layer->cpu().depth.at(2, 0) = 1.5F;
    layer->movers.pop_back();
    frame.layers = {layer};
    save(frame);
    const LoadedFrame again = loaded();
    ASSERT_NE(again.frame, nullptr);
    EXPECT_TRUE(same_bits(again.frame->layers[0]->cpu().depth, layer->cpu().depth));
    EXPECT_THAT(again.warnings, ElementsAre(HasSubstr("layer main: 3 depth values are no depth"),
                                            HasSubstr("layer main: 1 object ids (first 65535) have no entry")));
}

// Another program's depth map: metres, +inf where there is nothing.
TEST_F(FrameFolder, DistancesBecomeReversedDepth) {
    save(make_frame());
    std::string text = description();
    replace(text, "reverse_z", "distance_m");
    (void)temporary_.file("frame/frame.json", text);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    DepthImage distance{kSize_px, 2.0F};
    distance.at(0, 0) = kInfinity;
    distance.at(1, 0) = 0.05F;
    distance.at(2, 0) = 0.0F;
    distance.at(3, 0) = -1.0F;
    distance.at(4, 0) = std::numeric_limits<float>::quiet_NaN();
    ASSERT_TRUE(write_pfm(frame_path() / "main.depth.pfm", distance).ok());

    const LoadedFrame again = loaded();
    ASSERT_NE(again.frame, nullptr);
    const DepthImage& depth = again.frame->layers[0]->cpu().depth;
    EXPECT_EQ(depth.at(0, 0), 0.0F);
    // 0.05F is not quite 0.05, so not quite 1: the near plane in float.
    EXPECT_EQ(depth.at(1, 0), static_cast<float>(0.05 / static_cast<double>(0.05F)));
    EXPECT_EQ(depth.at(5, 3), 0.025F);
    EXPECT_THAT(again.warnings, ElementsAre(HasSubstr("3 depth values are no depth")));
}

TEST_F(FrameFolder, RefusesDescriptionsThatMakeNoSense) {
    EXPECT_EQ(refused("latewarp.frame/1", "latewarp.frame/9"), "schema is not latewarp.frame/1");
    EXPECT_EQ(refused("\"schema\"", "\"scheme\""), "schema is missing");
    EXPECT_EQ(refused("{", "["), "not valid JSON");
    EXPECT_EQ(refused("\"layers\": [", "\"layers\": 7, \"other\": ["), "layers is not a list of 1 to 256 layers");
    EXPECT_EQ(refused("\"layers\": [", "\"layers\": [], \"other\": ["), "layers is not a list of 1 to 256 layers");
    EXPECT_EQ(refused("\"name\": \"main\"", "\"name\": \"../main\""), "name is not 1-64 letters, digits, '-' and '_'");
    EXPECT_EQ(refused("shell-1_far", "main"), "two layers have the same name");
    EXPECT_EQ(refused("[7, 5]", "[7, 5, 1]"), "size_px is not a list of 2 numbers");
    EXPECT_EQ(refused("[7, 5]", "[0, 5]"), "size_px is not a whole number from 1 to 16384");
    EXPECT_EQ(refused("[7, 5]", "[7, 1000000000000]"), "size_px is not a whole number from 1 to 16384");
    EXPECT_EQ(refused("[7, 5]", "[7, 5.5]"), "size_px is not a whole number from 1 to 16384");
    EXPECT_EQ(refused("-0.9, 1.1", "1.1, -0.9"), "fov_tangents are not in order left < right, down < up");
    EXPECT_EQ(refused("-0.9, 1.1", "-1e9, 1.1"), "a tangent in fov_tangents is not usable");
    EXPECT_EQ(refused("-0.9, 1.1", "1.1"), "fov_tangents is not a list of 4 numbers");
    EXPECT_EQ(refused("\"near_m\": 0.05", "\"near_m\": 0"), "near_m is not above 0");
    EXPECT_EQ(refused("\"near_m\": 0.05", "\"near_m\": null"), "near_m is not a usable number");
    EXPECT_EQ(refused("\"near_m\": 0.05", "\"near_m\": 1e999"), "not valid JSON");
    EXPECT_EQ(refused("\"position_m\"", "\"position\""), "position_m is missing");
    EXPECT_EQ(refused("reverse_z", "z"), "depth_encoding is neither reverse_z nor distance_m");
    EXPECT_EQ(refused("\"depth_encoding\"", "\"encoding\""), "depth_encoding is missing");
    EXPECT_EQ(refused("\"time_s\": 12.35", "\"time_s\": \"now\""), "time_s is not a usable number");
    EXPECT_EQ(refused("\"id\": 2,", "\"id\": 0,"), "id is not a whole number from 1 to 65535");
    EXPECT_EQ(refused("\"id\": 2,", "\"id\": 65535,"), "object 65535 is there twice");
    EXPECT_EQ(refused("\"world_from_object\": [1", "\"world_from_object\": [1, 1"),
              "world_from_object is not a list of 16 numbers");
    EXPECT_EQ(refused("\"world_from_object\": [1, 0, 0, 0", "\"world_from_object\": [1, 0, 0, 3"),
              "world_from_object is not column-major and affine (numbers 4, 8, 12, 16 must be 0, 0, 0, 1)");
    EXPECT_EQ(refused("\"objects\": [", "\"objects\": 3, \"other\": ["), "objects is not a list of at most 65535");
}

TEST_F(FrameFolder, NormalisesQuaternionsAndRefusesZeroOnes) {
    save(make_frame());
    std::string text = description();
    const std::size_t at = text.find("\"orientation_xyzw\": [") + 21;
    const std::size_t end = text.find(']', at);
    (void)temporary_.file("frame/frame.json", text.replace(at, end - at, "0, 0, 0, 2"));
    const LoadedFrame again = loaded();
    ASSERT_NE(again.frame, nullptr);
    EXPECT_EQ(again.frame->layers[0]->camera.world_from_eye.orientation, glm::dquat(1.0, 0.0, 0.0, 0.0));
    EXPECT_THAT(again.warnings, ElementsAre(HasSubstr("orientation_xyzw has length 2: normalised")));

    replace(text, "[0, 0, 0, 2]", "[0, 0, 0, 0]");
    (void)temporary_.file("frame/frame.json", text);
    const auto refused_frame = load_frame_folder(frame_path());
    ASSERT_FALSE(refused_frame.ok());
    EXPECT_EQ(refused_frame.error().what, "orientation_xyzw is no rotation (zero quaternion)");
}

TEST_F(FrameFolder, RefusesImagesOfAnotherSizeAndMissingOnes) {
    EXPECT_EQ(refused("[7, 5]", "[8, 5]"), "the image is 7x5 and frame.json says 8x5");
    for (const char* file : {"main.color.png", "main.depth.pfm", "main.id.png", "frame.json"}) {
        save(make_frame());
        std::filesystem::remove(frame_path() / file);
        const auto missing = load_frame_folder(frame_path());
        ASSERT_FALSE(missing.ok()) << file;
        EXPECT_THAT(missing.error().where, HasSubstr(file));

        (void)temporary_.file(std::string{"frame/"} + file, "junk");
        EXPECT_FALSE(load_frame_folder(frame_path()).ok()) << file;
        (void)temporary_.file(std::string{"frame/"} + file, "");
        EXPECT_FALSE(load_frame_folder(frame_path()).ok()) << file;
    }
    EXPECT_FALSE(load_frame_folder(temporary_.path() / "nowhere").ok());
    EXPECT_FALSE(load_frame_folder(frame_path() / "frame.json").ok());
}

TEST_F(FrameFolder, RefusesHugeClaimsBeforeReadingAnything) {
    save(make_frame());
    std::string text = description();
    replace(text, "[7, 5]", "[16384, 16384]");
    (void)temporary_.file("frame/frame.json", text);
    const auto frame = load_frame_folder(frame_path());
    ASSERT_FALSE(frame.ok());
    EXPECT_EQ(frame.error().what, "the layers have 268435491 pixels in all");
}

TEST_F(FrameFolder, DeepNestingIsAnError) {
    std::string text = "{\"schema\": ";
    text += std::string(200'000, '[') + std::string(200'000, ']') + "}";
    (void)temporary_.file("frame/frame.json", text);
    const auto frame = load_frame_folder(frame_path());
    ASSERT_FALSE(frame.ok());
    EXPECT_EQ(frame.error().what, "JSON nested too deeply");
}

TEST_F(FrameFolder, SavingRefusesWhatCouldNotBeReadBack) {
    const auto what = [&](const auto& spoil) {
        RenderedFrame frame;
        auto layer = make_layer("main");
        spoil(*layer);
        frame.layers = {layer};
        const Status status = save_frame_folder(frame, frame_path());
        EXPECT_FALSE(status.ok());
        EXPECT_FALSE(std::filesystem::exists(frame_path())) << "nothing half-written";
        return status.ok() ? "saved" : status.error().what;
    };
    EXPECT_EQ(what([](Layer& layer) { layer.name = "a/b"; }), "'a/b' is no layer name");
    EXPECT_EQ(what([](Layer& layer) {
                  layer.cpu().depth = DepthImage{{3, 3}};
              }),
              "the images of layer main are not all 7x5");
    EXPECT_EQ(what([](Layer& layer) { layer.camera.near_m = std::nan(""); }), "near_m is not above 0");
    EXPECT_EQ(what([](Layer& layer) { layer.movers[0].world_from_object[3].x = std::nan(""); }),
              "layer main has unusable movers or time");
    EXPECT_EQ(what([](Layer& layer) { std::swap(layer.movers[0], layer.movers[1]); }),
              "layer main has unusable movers or time");
    EXPECT_FALSE(save_frame_folder(RenderedFrame{}, frame_path()).ok());
}

TEST_F(FrameFolder, AFailedSaveLeavesNoFrame) {
    save(make_frame());
    // A folder in the way of the last image.
    std::filesystem::remove(frame_path() / "shell-1_far.id.png");
    std::filesystem::create_directories(frame_path() / "shell-1_far.id.png" / "in-the-way");
    EXPECT_FALSE(save_frame_folder(make_frame(), frame_path()).ok());
    EXPECT_FALSE(std::filesystem::exists(frame_path() / "frame.json"));
    EXPECT_FALSE(std::filesystem::exists(frame_path() / "main.color.png"));

    const std::string file = temporary_.file("file", "x");
    EXPECT_FALSE(save_frame_folder(make_frame(), file).ok());
    EXPECT_FALSE(save_frame_folder(make_frame(), std::filesystem::path{file} / "below").ok());
}

TEST_F(FrameFolder, ObjectListsComeAloneOrInAnObject) {
    const std::string one = "{\"id\": 7, \"world_from_object\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 4,5,6,1]}";
    const std::string two = "{\"id\": 3, \"world_from_object\": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1]}";
    for (const std::string& text : {"[" + one + "," + two + "]", "{\"objects\": [" + one + ", " + two + "]}"}) {
        const auto objects = load_object_transforms(temporary_.file("objects.json", text));
        ASSERT_TRUE(objects.ok()) << objects.error().message();
        ASSERT_EQ(objects->size(), 2U);
        EXPECT_EQ((*objects)[0].id, 3) << "by ascending id";
        EXPECT_EQ((*objects)[1].world_from_object[3], glm::dvec4(4.0, 5.0, 6.0, 1.0));
    }
    for (const char* text : {"", "{}", "[1]", "[{\"id\": 7}]", "{\"objects\": null}", "hello", "\xff\xfe"}) {
        EXPECT_FALSE(load_object_transforms(temporary_.file("objects.json", text)).ok()) << text;
    }
    EXPECT_FALSE(load_object_transforms(temporary_.path() / "missing.json").ok());
    EXPECT_FALSE(load_object_transforms(temporary_.path()).ok());
}

}  // namespace
}  // namespace lw
