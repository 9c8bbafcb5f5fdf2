#include "warp_server/photon_code.h"

#include <algorithm>

namespace lw {
namespace {

constexpr int kBits = kPhotonCodeColumns * kPhotonCodeRows;
constexpr int kLargestCell_px = 4;

int cell_size_px(const ColourImage& picture, int top_px, int height_px) {
    const int rows = std::min(height_px, picture.height() - top_px);
    return std::min({kLargestCell_px, picture.width() / kPhotonCodeColumns, rows / kPhotonCodeRows});
}

std::uint16_t check_bits(std::uint64_t payload) {
    std::uint32_t crc = 0xFFFF;
    for (int shift = 40; shift >= 0; shift -= 8) {
        crc ^= static_cast<std::uint32_t>(payload >> shift & 0xFF) << 8;
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 0x8000) != 0 ? crc << 1 ^ 0x1021 : crc << 1;
    }
    return static_cast<std::uint16_t>(crc);
}

std::uint64_t word_of(const PhotonCode& code) {
    const std::uint64_t payload = std::uint64_t{code.pose_sample} << 16 | code.frame;
    return payload << 16 | check_bits(payload);
}

struct Cell {
    int x_px;
    int y_px;
    std::uint64_t bit;
};
Cell cell_of(int index, int size_px, int top_px) {
    return {index % kPhotonCodeColumns * size_px, top_px + index / kPhotonCodeColumns * size_px,
            std::uint64_t{1} << (kBits - 1 - index)};
}

}  // namespace

bool write_photon_code(ColourImage& picture, int top_px, int height_px, const PhotonCode& code) {
    const int size_px = cell_size_px(picture, top_px, height_px);
    if (size_px < 1) return false;
    const std::uint64_t word = word_of(code);
    for (int index = 0; index < kBits; ++index) {
        const Cell cell = cell_of(index, size_px, top_px);
        const std::uint8_t level = (word & cell.bit) != 0 ? 255 : 0;
        for (int y = 0; y < size_px; ++y) {
            for (int x = 0; x < size_px; ++x) picture.at(cell.x_px + x, cell.y_px + y) = {level, level, level, 255};
        }
    }
    return true;
}

std::optional<PhotonCode> read_photon_code(const ColourImage& picture, int top_px, int height_px) {
    const int size_px = cell_size_px(picture, top_px, height_px);
    if (size_px < 1) return std::nullopt;
    std::uint64_t word = 0;
    for (int index = 0; index < kBits; ++index) {
        const Cell cell = cell_of(index, size_px, top_px);
        if (picture.at(cell.x_px + size_px / 2, cell.y_px + size_px / 2).g >= 128) word |= cell.bit;
    }
    const std::uint64_t payload = word >> 16;
    if (check_bits(payload) != static_cast<std::uint16_t>(word)) return std::nullopt;
    return PhotonCode{static_cast<std::uint32_t>(payload >> 16), static_cast<std::uint16_t>(payload)};
}

}  // namespace lw
