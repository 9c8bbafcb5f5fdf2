#include "core/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/png_encoder.h"

namespace lw {
namespace {

using ::testing::HasSubstr;

// A folder of this test's own, emptied first.
class ImageIo : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::path{LW_TEST_OUTPUT_DIR} / "core" / info->name();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder_ / name; }
    [[nodiscard]] std::size_t files_in_folder() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator{folder_}, {}));
    }
    void write_text(const std::string& name, std::string_view text) const {
        ASSERT_TRUE(write_file_atomically(file(name), std::as_bytes(std::span{text.data(), text.size()})).ok());
    }

private:
    std::filesystem::path folder_;
};

ColourImage pattern(glm::ivec2 size_px, bool opaque) {
    ColourImage image{size_px};
    std::uint32_t seed = 9;
    for (int y = 0; y < size_px.y; ++y) {
        for (int x = 0; x < size_px.x; ++x) {
            seed = seed * 1664525U + 1013904223U;
            // Half smooth, half noise: every row filter gets its turn.
            const auto random = static_cast<std::uint8_t>(y % 3 == 0 ? seed >> 24U : 0U);
            image.at(x, y) = {static_cast<std::uint8_t>(x * 3 + random), static_cast<std::uint8_t>(y * 5),
                              static_cast<std::uint8_t>(x + y), static_cast<std::uint8_t>(opaque ? 255 : x * 7)};
        }
    }
    return image;
}

TEST_F(ImageIo, ColourRoundTripsWithAndWithoutAlpha) {
    for (const bool opaque : {true, false}) {
        for (const glm::ivec2& size_px : {glm::ivec2{1, 1}, glm::ivec2{67, 41}, glm::ivec2{3, 200}}) {
            const ColourImage image = pattern(size_px, opaque);
            ASSERT_TRUE(write_png(file("a.png"), image).ok());
            const auto back = read_png(file("a.png"));
            ASSERT_TRUE(back) << back.error().message();
            EXPECT_EQ(*back, image);
        }
    }
}

TEST_F(ImageIo, TheSameImageGivesTheSameBytes) {
    const ColourImage image = pattern({50, 50}, true);
    ASSERT_TRUE(write_png(file("a.png"), image).ok());
    ASSERT_TRUE(write_png(file("b.png"), image).ok());
    EXPECT_EQ(*read_file(file("a.png")), *read_file(file("b.png")));
    EXPECT_EQ(files_in_folder(), 2U) << "no temporary file stays behind";
}

TEST_F(ImageIo, SixteenBitIdsRoundTrip) {
    ObjectIdImage ids{{256, 256}};
    for (std::size_t i = 0; i < ids.pixels().size(); ++i) ids.pixels()[i] = static_cast<std::uint16_t>(i);
    ASSERT_TRUE(write_png16(file("id.png"), ids).ok());
    const auto back = read_png16(file("id.png"));
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(*back, ids);
}

TEST_F(ImageIo, EightBitImagesAreNoIds) {
    ASSERT_TRUE(write_png(file("a.png"), pattern({4, 4}, true)).ok());
    const auto ids = read_png16(file("a.png"));
    ASSERT_FALSE(ids);
    EXPECT_THAT(ids.error().message(), HasSubstr("not a PNG of one channel with 16 bits"));
}

TEST_F(ImageIo, PfmRoundTripsEveryKindOfValue) {
    DepthImage depth{{3, 2}};
    depth.at(0, 0) = 1.0F;
    depth.at(1, 0) = std::numeric_limits<float>::infinity();
    depth.at(2, 0) = std::numeric_limits<float>::denorm_min();
    depth.at(0, 1) = std::numeric_limits<float>::quiet_NaN();
    depth.at(1, 1) = -0.0F;
    ASSERT_TRUE(write_pfm(file("d.pfm"), depth).ok());
    const auto back = read_pfm(file("d.pfm"));
    ASSERT_TRUE(back) << back.error().message();
    EXPECT_EQ(std::memcmp(back->pixels().data(), depth.pixels().data(), depth.size_bytes()), 0);
}

TEST_F(ImageIo, PfmStoresTheBottomRowFirstInEitherByteOrder) {
    using namespace std::string_view_literals;
    write_text("little.pfm", "Pf\n1 2\n-1.0\n\x00\x00\x80\x3F\x00\x00\x00\x40"sv);  // 1, then 2
    write_text("big.pfm", "Pf\n1 2\n1.0\n\x3F\x80\x00\x00\x40\x00\x00\x00"sv);
    for (const char* name : {"little.pfm", "big.pfm"}) {
        const auto depth = read_pfm(file(name));
        ASSERT_TRUE(depth) << depth.error().message();
        EXPECT_EQ(depth->at(0, 0), 2.0F);
        EXPECT_EQ(depth->at(0, 1), 1.0F);
    }
}

TEST_F(ImageIo, BadPfmFilesAreRefused) {
    const std::pair<std::string_view, const char*> cases[] = {
        {"", "empty"},
        {"P", "not a one-channel PFM"},
        {"Pf", "not a one-channel PFM"},
        {"Pf\n2 2\n", "not a one-channel PFM"},
        {"Pf\n2 two\n-1\n", "not a one-channel PFM"},
        {"Pf\n2 2\n0\n0123456789abcdef", "not a one-channel PFM"},
        {"Pf\n2 2\nnan\n0123456789abcdef", "not a one-channel PFM"},
        {"PF\n1 1\n-1\n0123456789ab", "three channels"},
        {"Pf\n0 4\n-1\n", "0x4"},
        {"Pf\n-2 -2\n-1\n0123456789abcdef", "-2x-2"},
        {"Pf\n100000 100000\n-1\n", "100000x100000"},
        {"Pf\n99999999999 1\n-1\n", "not a one-channel PFM"},
        {"Pf\n16384 16384\n-1\n", "16384x16384"},
        {"Pf\n2 2\n-1\n0123456789abcde", "15 bytes of depth"},
        {"Pf\n2 2\n-1\n0123456789abcdefg", "17 bytes of depth"},
    };
    for (const auto& [text, expected] : cases) {
        write_text("bad.pfm", text);
        const auto depth = read_pfm(file("bad.pfm"));
        ASSERT_FALSE(depth) << text;
        EXPECT_THAT(depth.error().message(), HasSubstr(expected)) << text;
        EXPECT_THAT(depth.error().message(), HasSubstr("bad.pfm"));
    }
}

// Every prefix of a file, and every file with one byte changed, is read or refused, never worse.
TEST_F(ImageIo, CutAndCorruptedPngFilesAreReadOrRefused) {
    ObjectIdImage ids{{9, 7}};
    for (std::size_t i = 0; i < ids.pixels().size(); ++i) ids.pixels()[i] = static_cast<std::uint16_t>(i * 1031U);
    ASSERT_TRUE(write_png16(file("id.png"), ids).ok());
    const std::vector<std::uint8_t> whole = *read_file(file("id.png"));
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const auto image = decode_image(std::span{whole}.first(length), "cut");
        // Past the last row's data stb does not miss the end.
        EXPECT_TRUE(!image || length + 20 > whole.size()) << length;
    }
    for (std::size_t at = 0; at < whole.size(); ++at) {
        std::vector<std::uint8_t> changed = whole;
        changed[at] ^= 0x55U;
        const auto image = decode_image(changed, "changed");
        if (image) {
            EXPECT_EQ(image->pixels().size(), static_cast<std::size_t>(image->width()) * image->height());
        }
        ASSERT_TRUE(write_file_atomically(file("changed.png"), std::as_bytes(std::span{changed})).ok());
        (void)read_png16(file("changed.png"));
    }
}

TEST_F(ImageIo, ClaimsAreCheckedBeforeMemoryIsTaken) {
    // A valid header with the size patched; stb does not check its checksum.
    ASSERT_TRUE(write_png(file("a.png"), pattern({2, 2}, true)).ok());
    std::vector<std::uint8_t> bytes = *read_file(file("a.png"));
    const auto claim = [&](std::uint32_t width, std::uint32_t height) {
        for (int i = 0; i < 4; ++i) {
            bytes[static_cast<std::size_t>(16 + i)] = static_cast<std::uint8_t>(width >> (24 - 8 * i));
            bytes[static_cast<std::size_t>(20 + i)] = static_cast<std::uint8_t>(height >> (24 - 8 * i));
        }
        const auto image = decode_image(bytes, "claim.png");
        return image ? std::string{"read"} : image.error().message();
    };
    EXPECT_THAT(claim(20000, 4), HasSubstr("20000x4"));
    EXPECT_THAT(claim(16384, 16384), HasSubstr("16384x16384"));
    EXPECT_THAT(claim(8192, 8192), HasSubstr("cannot hold"));
    EXPECT_THAT(claim(0, 0), HasSubstr("claim.png"));
    EXPECT_THAT(claim(0xFFFFFFFF, 0xFFFFFFFF), HasSubstr("claim.png"));
    EXPECT_EQ(claim(2, 2), "read");
}

TEST_F(ImageIo, WhatIsNoImageIsRefusedWithItsName) {
    write_text("empty.png", "");
    write_text("text.png", "this is a text of more than thirty-three bytes, not a picture");
    EXPECT_THAT(read_png(file("empty.png")).error().message(), HasSubstr("empty.png"));
    EXPECT_THAT(read_png(file("text.png")).error().message(), HasSubstr("not a PNG file"));
    EXPECT_THAT(read_png(file("missing.png")).error().message(), HasSubstr("no such file"));
    EXPECT_THAT(read_png(file("")).error().message(), HasSubstr("is a folder"));
    EXPECT_THAT(decode_image({}, "nothing").error().message(), HasSubstr("empty"));
}

TEST_F(ImageIo, UnwritablePlacesLeaveNothingBehind) {
    const ColourImage image = pattern({4, 4}, true);
    EXPECT_FALSE(write_png(file("no/such/folder.png"), image).ok());
    EXPECT_FALSE(write_png(file(""), image).ok());
    EXPECT_FALSE(write_png(file("zero.png"), ColourImage{}).ok());
    EXPECT_FALSE(write_pfm(file("zero.pfm"), DepthImage{}).ok());
    EXPECT_EQ(files_in_folder(), 0U);
}

TEST_F(ImageIo, FilesAboveTheLimitAreNotRead) {
    write_text("ten.txt", "0123456789");
    EXPECT_EQ(read_file(file("ten.txt"), 10)->size(), 10U);
    EXPECT_THAT(read_file(file("ten.txt"), 9).error().message(), HasSubstr("10 bytes are more than the 9"));
    EXPECT_FALSE(read_file("/dev/zero").ok());
}

}  // namespace
}  // namespace lw
