#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>

#include "core/image_io.h"

namespace lw {
namespace {

static_assert(std::endian::native == std::endian::little, "PFM files are written as memory holds them");

constexpr std::string_view kBlanks = " \t\r\n";

struct Header {
    glm::ivec2 size_px{0};
    bool little_endian = true;
    std::size_t data_offset = 0;
};

// The next word, and the position of the one blank that ends it; nothing at the end of the text.
std::string_view next_word(std::string_view text, std::size_t& position) {
    const std::size_t begin = text.find_first_not_of(kBlanks, position);
    if (begin == std::string_view::npos) return {};
    const std::size_t end = text.find_first_of(kBlanks, begin);
    if (end == std::string_view::npos) return {};
    position = end;
    return text.substr(begin, end - begin);
}

template <class T>
bool parse(std::string_view word, T& value) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc{} && end == word.data() + word.size();
}

Result<Header> parse_header(std::span<const std::uint8_t> bytes, const std::string& where) {
    // The three lines are short; what lies further on is data.
    const std::string_view text{reinterpret_cast<const char*>(bytes.data()), std::min<std::size_t>(bytes.size(), 128)};
    const Error malformed{"not a one-channel PFM file", where, "the file begins with 'Pf', its size and its scale"};
    std::size_t position = 0;
    const std::string_view kind = next_word(text, position);
    if (kind == "PF") return Error{"the PFM file has three channels", where, "depth has one: write it as 'Pf'"};
    Header header;
    double scale = 0.0;
    if (kind != "Pf" || !text.starts_with("Pf")) return malformed;
    if (!parse(next_word(text, position), header.size_px.x)) return malformed;
    if (!parse(next_word(text, position), header.size_px.y)) return malformed;
    if (!parse(next_word(text, position), scale) || !std::isfinite(scale) || scale == 0.0) return malformed;
    header.little_endian = scale < 0.0;
    header.data_offset = position + 1;
    return header;
}

float value_at(const std::uint8_t* bytes, bool little_endian) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof(bits));
    if (!little_endian) {
        bits = (bits >> 24U) | ((bits >> 8U) & 0xFF00U) | ((bits << 8U) & 0xFF0000U) | (bits << 24U);
    }
    return std::bit_cast<float>(bits);
}

}  // namespace

Result<DepthImage> read_pfm(const std::filesystem::path& path) {
    const std::string where = path.string();
    const auto bytes = read_file(path, std::uint64_t{1} << 30U);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return Error{"the file is empty", where, "give a PFM file"};
    const Result<Header> header = parse_header(*bytes, where);
    if (!header) return header.error();
    const glm::ivec2 size_px = header->size_px;
    const std::int64_t pixels = std::int64_t{size_px.x} * size_px.y;
    if (size_px.x < 1 || size_px.y < 1 || size_px.x > kMaxImageSidePx || size_px.y > kMaxImageSidePx ||
        pixels > kMaxImagePixels) {
        return Error{fmt::format("the PFM file claims {}x{} pixels", size_px.x, size_px.y), where,
                     fmt::format("sides of 1 to {} and at most {} in all are read", kMaxImageSidePx, kMaxImagePixels)};
    }
    const auto expected_bytes = static_cast<std::size_t>(pixels) * sizeof(float);
    if (bytes->size() - header->data_offset != expected_bytes) {
        return Error{fmt::format("{} bytes of depth where {}x{} pixels need {}", bytes->size() - header->data_offset,
                                 size_px.x, size_px.y, expected_bytes),
                     where, "write or copy the file again"};
    }
    DepthImage image{size_px};
    const std::uint8_t* data = bytes->data() + header->data_offset;
    for (int y = size_px.y - 1; y >= 0; --y) {
        for (float& value : image.row(y)) {
            value = value_at(data, header->little_endian);
            data += sizeof(float);
        }
    }
    return image;
}

Status write_pfm(const std::filesystem::path& path, const DepthImage& image) {
    if (image.empty()) return Error{"an image without pixels cannot be written", path.string(), "give it a size"};
    const std::string header = fmt::format("Pf\n{} {}\n-1.0\n", image.width(), image.height());
    std::vector<std::byte> bytes(header.size() + image.size_bytes());
    std::memcpy(bytes.data(), header.data(), header.size());
    std::byte* out = bytes.data() + header.size();
    for (int y = image.height() - 1; y >= 0; --y) {
        const auto row = std::as_bytes(image.row(y));
        std::memcpy(out, row.data(), row.size());
        out += row.size();
    }
    return write_file_atomically(path, bytes);
}

}  // namespace lw
