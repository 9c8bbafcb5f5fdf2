#include "scene/encoded_image.h"

#include <array>
#include <cstring>

namespace lw::scene {
namespace {

// 8-bit PNG: inflated rows (4) and their unfiltered copy (4). 16-bit PNG: both 8, less the result. JPEG: planes (3),
// and for progressive ones coefficients (6) and padding.
constexpr int kPng8BytesPerPx = 8;
constexpr int kOtherBytesPerPx = 14;

int big_endian_u16(std::span<const std::uint8_t> bytes, std::size_t offset) {
    return bytes[offset] << 8 | bytes[offset + 1];
}

std::optional<EncodedImage> peek_png(std::span<const std::uint8_t> bytes) {
    constexpr std::size_t kSizeOffset = 16;
    constexpr std::size_t kBitsOffset = 24;
    if (bytes.size() <= kBitsOffset) return std::nullopt;
    // Sides over 31 bits are nonsense; those over 16 are refused by every reader we have.
    if (big_endian_u16(bytes, kSizeOffset) != 0 || big_endian_u16(bytes, kSizeOffset + 4) != 0) return std::nullopt;
    return EncodedImage{{big_endian_u16(bytes, kSizeOffset + 2), big_endian_u16(bytes, kSizeOffset + 6)},
                        bytes[kBitsOffset] == 16 ? kOtherBytesPerPx : kPng8BytesPerPx};
}

/// Start of frame: 0xC0 to 0xCF without the tables and reserved codes in between.
bool is_frame_marker(std::uint8_t marker) {
    return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

std::optional<EncodedImage> peek_jpeg(std::span<const std::uint8_t> bytes) {
    std::size_t offset = 2;
    while (offset + 4 <= bytes.size()) {
        if (bytes[offset] != 0xFF) return std::nullopt;
        const std::uint8_t marker = bytes[offset + 1];
        if (marker == 0xFF) {  // fill byte
            ++offset;
            continue;
        }
        if (is_frame_marker(marker)) {
            if (offset + 9 > bytes.size()) return std::nullopt;
            return EncodedImage{{big_endian_u16(bytes, offset + 7), big_endian_u16(bytes, offset + 5)},
                                kOtherBytesPerPx};
        }
        offset += 2 + static_cast<std::size_t>(big_endian_u16(bytes, offset + 2));
    }
    return std::nullopt;
}

}  // namespace

std::optional<EncodedImage> peek_image(std::span<const std::uint8_t> bytes) {
    constexpr std::array<std::uint8_t, 8> kPngSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    if (bytes.size() > kPngSignature.size() &&
        std::memcmp(bytes.data(), kPngSignature.data(), kPngSignature.size()) == 0) {
        return peek_png(bytes);
    }
    if (bytes.size() > 4 && bytes[0] == 0xFF && bytes[1] == 0xD8) return peek_jpeg(bytes);
    return std::nullopt;
}

}  // namespace lw::scene
