// Images that claim one thing and hold another.

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "core/image_io.h"
#include "core/png_inflate_check.h"
#include "scene/encoded_image.h"
#include "tests/scene/resident_memory.h"

namespace lw::scene {
namespace {

/// Deflate's bits, lowest first in each byte.
class BitWriter {
public:
    std::vector<std::uint8_t> bytes;

    /// Huffman codes go out highest bit first.
    void code(std::uint32_t bits, int count) {
        for (int i = count - 1; i >= 0; --i) bit((bits >> i & 1) != 0);
    }
    void bit(bool set) {
        if (used_ == 0) bytes.push_back(0);
        if (set) bytes.back() = static_cast<std::uint8_t>(bytes.back() | 1 << used_);
        used_ = (used_ + 1) % 8;
    }

private:
    int used_ = 0;
};

/// A zlib stream of one fixed-Huffman block: a zero, then `repeats` copies of 258 zeros (RFC 1951, 3.2.6).
std::vector<std::uint8_t> squeezed_zeros(int repeats) {
    BitWriter writer;
    writer.bytes = {0x78, 0x01};
    writer.bit(true);  // last block
    writer.bit(true);  // fixed codes: 01, low bit first
    writer.bit(false);
    writer.code(0x30, 8);  // literal 0
    for (int i = 0; i < repeats; ++i) {
        writer.code(0xC5, 8);  // length 258
        writer.code(0, 5);     // distance 1
    }
    writer.code(0, 7);                                      // end
    writer.bytes.insert(writer.bytes.end(), {0, 0, 0, 0});  // checksum, which stb does not read
    return writer.bytes;
}

void append_chunk(std::vector<std::uint8_t>& png, const char* type, const std::vector<std::uint8_t>& data) {
    for (int shift = 24; shift >= 0; shift -= 8) png.push_back(static_cast<std::uint8_t>(data.size() >> shift & 0xFF));
    png.insert(png.end(), type, type + 4);
    png.insert(png.end(), data.begin(), data.end());
    png.insert(png.end(), {0, 0, 0, 0});
}

/// A grey picture of 16 x 16 pixels with that much pixel data.
std::vector<std::uint8_t> grey_png(int repeats) {
    std::vector<std::uint8_t> png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    append_chunk(png, "IHDR", {0, 0, 0, 16, 0, 0, 0, 16, 8, 0, 0, 0, 0});
    append_chunk(png, "IDAT", squeezed_zeros(repeats));
    append_chunk(png, "IEND", {});
    return png;
}

TEST(GltfImages, PixelDataFarBeyondItsPictureIsRefused) {
    const auto sound = grey_png(2);  // 517 bytes, 16 rows need 272
    EXPECT_TRUE(decode_image(sound, "sound").ok());
    const auto bomb = grey_png(4'000'000);  // 6.5 MB that inflate to a gigabyte
    EXPECT_FALSE(png_data_fits(bomb, {16, 16}));
    EXPECT_FALSE(decode_image(bomb, "bomb").ok());
    EXPECT_LT(test::peak_resident_bytes(), test::kMaxResidentBytes);
}

TEST(GltfImages, HeadersAreReadWithoutDecoding) {
    const auto png = peek_image(grey_png(2));
    ASSERT_TRUE(png.has_value());
    EXPECT_EQ(png->size_px, glm::ivec2(16, 16));
    // SOI, an APP0 segment of 4 bytes, SOF2 with height 5 and width 7.
    const std::vector<std::uint8_t> jpeg = {0xFF, 0xD8, 0xFF, 0xE0, 0, 4, 1, 2, 0xFF, 0xC2, 0, 11, 8, 0, 5, 0, 7, 1};
    const auto frame = peek_image(jpeg);
    ASSERT_TRUE(frame.has_value());
    EXPECT_EQ(frame->size_px, glm::ivec2(7, 5));
    for (std::size_t size = 0; size < jpeg.size() - 1; ++size) {
        EXPECT_FALSE(peek_image(std::span{jpeg}.first(size)).has_value()) << size;
    }
}

}  // namespace
}  // namespace lw::scene
