#include "core/png_encoder.h"

#include <array>
#include <cstdlib>
#include <limits>

// stb_image_write exports it but declares it only beside its definition. `quality` is the length of the hash chains.
extern "C" unsigned char* stbi_zlib_compress(unsigned char* data, int data_len, int* out_len, int quality);

namespace lw {
namespace {

// 8 is stb's own default; larger values cost time and gain under 1 % on rendered pictures.
constexpr int kCompressionQuality = 8;

std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t n = 0; n < 256; ++n) {
        std::uint32_t c = n;
        for (int bit = 0; bit < 8; ++bit) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        table[n] = c;
    }
    return table;
}

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
    static const std::array<std::uint32_t, 256> table = make_crc_table();
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const std::uint8_t byte : bytes) crc = table[(crc ^ byte) & 0xFFU] ^ (crc >> 8U);
    return ~crc;
}

void append_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void append_chunk(std::vector<std::uint8_t>& out, const char (&type)[5], std::span<const std::uint8_t> data) {
    append_u32(out, static_cast<std::uint32_t>(data.size()));
    const std::size_t begin = out.size();
    out.insert(out.end(), type, type + 4);
    out.insert(out.end(), data.begin(), data.end());
    append_u32(out, crc32_of({out.data() + begin, out.size() - begin}));
}

int paeth(int left, int above, int above_left) {
    const int estimate = left + above - above_left;
    const int to_left = std::abs(estimate - left);
    const int to_above = std::abs(estimate - above);
    const int to_above_left = std::abs(estimate - above_left);
    if (to_left <= to_above && to_left <= to_above_left) return left;
    return to_above <= to_above_left ? above : above_left;
}

int predicted(int filter, int left, int above, int above_left) {
    switch (filter) {
        case 1:
            return left;
        case 2:
            return above;
        case 3:
            return (left + above) / 2;
        case 4:
            return paeth(left, above, above_left);
        default:
            return 0;
    }
}

// Filters one row; `above` is empty for the first. Returns the sum of the absolute residuals.
std::uint64_t filter_row(int filter, std::span<const std::uint8_t> row, std::span<const std::uint8_t> above,
                         std::size_t bytes_per_pixel, std::uint8_t* out) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const bool has_left = i >= bytes_per_pixel;
        const int left = has_left ? row[i - bytes_per_pixel] : 0;
        const int up = above.empty() ? 0 : above[i];
        const int up_left = has_left && !above.empty() ? above[i - bytes_per_pixel] : 0;
        const auto residual = static_cast<std::uint8_t>(row[i] - predicted(filter, left, up, up_left));
        out[i] = residual;
        sum += static_cast<std::uint64_t>(residual < 128 ? residual : 256 - residual);
    }
    return sum;
}

// Per row the filter with the smallest sum of absolute residuals, the standard's own advice (section 12.8).
std::vector<std::uint8_t> filter_image(std::span<const std::uint8_t> bytes, std::size_t row_bytes,
                                       std::size_t bytes_per_pixel) {
    const std::size_t rows = bytes.size() / row_bytes;
    std::vector<std::uint8_t> filtered;
    filtered.reserve(rows * (row_bytes + 1));
    std::vector<std::uint8_t> candidate(row_bytes);
    std::vector<std::uint8_t> best(row_bytes);
    for (std::size_t y = 0; y < rows; ++y) {
        const auto row = bytes.subspan(y * row_bytes, row_bytes);
        const auto above = y == 0 ? std::span<const std::uint8_t>{} : bytes.subspan((y - 1) * row_bytes, row_bytes);
        int best_filter = 0;
        std::uint64_t best_sum = std::numeric_limits<std::uint64_t>::max();
        for (int filter = 0; filter <= 4; ++filter) {
            const std::uint64_t sum = filter_row(filter, row, above, bytes_per_pixel, candidate.data());
            if (sum >= best_sum) continue;
            best_sum = sum;
            best_filter = filter;
            best.swap(candidate);
        }
        filtered.push_back(static_cast<std::uint8_t>(best_filter));
        filtered.insert(filtered.end(), best.begin(), best.end());
    }
    return filtered;
}

}  // namespace

std::vector<std::uint8_t> encode_png(glm::ivec2 size_px, PngColour colour, int bits,
                                     std::span<const std::uint8_t> bytes) {
    const std::size_t channels = colour == PngColour::grey ? 1 : colour == PngColour::rgb ? 3 : 4;
    const std::size_t bytes_per_pixel = channels * static_cast<std::size_t>(bits) / 8;
    std::vector<std::uint8_t> filtered =
        filter_image(bytes, bytes_per_pixel * static_cast<std::size_t>(size_px.x), bytes_per_pixel);
    if (filtered.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) return {};

    int compressed_size = 0;
    unsigned char* compressed =
        stbi_zlib_compress(filtered.data(), static_cast<int>(filtered.size()), &compressed_size, kCompressionQuality);
    if (compressed == nullptr) return {};

    std::vector<std::uint8_t> header;
    append_u32(header, static_cast<std::uint32_t>(size_px.x));
    append_u32(header, static_cast<std::uint32_t>(size_px.y));
    header.insert(header.end(), {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(colour), 0, 0, 0});

    std::vector<std::uint8_t> file{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    append_chunk(file, "IHDR", header);
    append_chunk(file, "IDAT", {compressed, static_cast<std::size_t>(compressed_size)});
    append_chunk(file, "IEND", {});
    std::free(compressed);  // NOLINT(cppcoreguidelines-no-malloc): stb allocates with malloc
    return file;
}

}  // namespace lw
