#include "core/png_inflate_check.h"

#include <stb_image.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

namespace lw {
namespace {

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kChunkFrameBytes = 12;  // length, type, checksum
// Deflate shrinks at most 1032 times.
constexpr std::uint64_t kMaxRatio = 1032;
// Not worth a second look: what inflates to less than this harms nobody.
constexpr std::uint64_t kHarmlessBytes = std::uint64_t{64} << 20;
// Offsets into the file: IHDR is always the first chunk.
constexpr std::size_t kBitsOffset = 24;
constexpr std::size_t kColourTypeOffset = 25;
constexpr std::size_t kInterlaceOffset = 28;

std::size_t big_endian_u32(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return static_cast<std::size_t>(bytes[offset]) << 24 | static_cast<std::size_t>(bytes[offset + 1]) << 16 |
           static_cast<std::size_t>(bytes[offset + 2]) << 8 | static_cast<std::size_t>(bytes[offset + 3]);
}

std::uint64_t channels_of(std::uint8_t colour_type) {
    switch (colour_type) {
        case 2:
            return 3;
        case 4:
            return 2;
        case 6:
            return 4;
        default:
            return 1;  // grey or palette
    }
}

/// Bytes of all rows with their filter bytes, as they come out of inflation.
std::uint64_t row_data_bytes(std::span<const std::uint8_t> png, glm::ivec2 size_px) {
    const std::uint64_t bits_per_px = png[kBitsOffset] * channels_of(png[kColourTypeOffset]);
    const std::uint64_t row_bytes = (static_cast<std::uint64_t>(size_px.x) * bits_per_px + 7) / 8 + 1;
    const std::uint64_t bytes = row_bytes * static_cast<std::uint64_t>(size_px.y);
    // Interlaced files split the picture into seven: more filter bytes, and rows rounded up to bytes.
    return png[kInterlaceOffset] == 0 ? bytes : 2 * bytes + 64;
}

/// All IDAT chunks in one piece.
std::vector<char> pixel_data(std::span<const std::uint8_t> png) {
    std::vector<char> data;
    std::size_t offset = kSignatureBytes;
    while (png.size() >= kChunkFrameBytes && offset <= png.size() - kChunkFrameBytes) {
        const std::size_t length = big_endian_u32(png, offset);
        if (length > png.size() - offset - kChunkFrameBytes) break;
        if (std::memcmp(png.data() + offset + 4, "IDAT", 4) == 0) {
            const auto chunk = png.subspan(offset + 8, length);
            data.insert(data.end(), chunk.begin(), chunk.end());
        }
        offset += kChunkFrameBytes + length;
    }
    return data;
}

}  // namespace

bool png_data_fits(std::span<const std::uint8_t> png, glm::ivec2 size_px) {
    if (png.size() * kMaxRatio <= kHarmlessBytes) return true;
    if (png.size() <= kInterlaceOffset || std::memcmp(png.data() + 1, "PNG", 3) != 0) return true;
    const std::uint64_t largest = std::max(kHarmlessBytes, row_data_bytes(png, size_px));
    const std::vector<char> data = pixel_data(png);
    if (data.size() * kMaxRatio <= largest) return true;
    if (largest > std::numeric_limits<int>::max() || data.size() > std::numeric_limits<int>::max()) return true;
    // Not cleared: only what is written becomes resident.
    const std::unique_ptr<char[]> inflated{new char[largest]};
    return stbi_zlib_decode_buffer(inflated.get(), static_cast<int>(largest), data.data(),
                                   static_cast<int>(data.size())) >= 0;
}

}  // namespace lw
